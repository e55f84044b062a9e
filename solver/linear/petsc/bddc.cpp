// BDDC [dohrmann-2003] on the symmetric part of the flexible block, with one factor per rank for all of its subdomains.
//
// The preconditioner is that of exact static condensation: K^-1 with the inverse of the assembled Schur complement replaced by
//
//     sum_j  D_j ( Psi_j K_c^-1 Psi_j^T  +  S_j^-1 restricted to C_j w = 0 ) D_j ,
//
// D_j weights that sum to one (by stiffness: of whole classes, "deluxe" [dohrmann-widlund-2016], where they are not too large), C_j the
// averages and moments of classes of shared nodes (and more where those do not do, class_matrices.hpp), Psi_j the interface motions of
// least energy with C_j Psi_j = 1, K_c their stiffness. Floating subdomains are made regular by C^T R C, which changes nothing on C w = 0.
// With the interface last in its factor, an application reads the factor once forwards and once backwards; PETSc's PCBDDC solves three
// times with two factors.
//
// The tangent of averaged methods is unsymmetric by what turns in a step; GMRES works on it, and only the preconditioner is symmetrised.
#include <petscvec.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include "base/stopwatch.hpp"
#include "linear/petsc/class_matrices.hpp"
#include "linear/petsc/interface.hpp"
#include "linear/petsc/solver.hpp"
#include "linear/petsc/subdomain_factor.hpp"

namespace hilo::petsc {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Iterations beyond which constraints are added.
constexpr int too_many = 20;

class Bddc final : public FlexibleInverse {
 public:
  explicit Bddc(const SubdomainMatrix& F) : F_(F), interface_(find_interface(F)), factor_(F, interface_), pieces_(interface_.n_pieces) {
    n_ = factor_.n(), n_interior_ = factor_.n_interior();
    for (size_t p = 0; p < pieces_.size(); ++p) {
      pieces_[p].from = factor_.begin(static_cast<int>(p)) - n_interior_;
      pieces_[p].n = factor_.begin(static_cast<int>(p) + 1) - factor_.begin(static_cast<int>(p));
    }
    make_scatters();
  }
  ~Bddc() override {
    VecScatterDestroy(&all_), VecScatterDestroy(&edge_);
    VecDestroy(&local_), VecDestroy(&edge_local_);
  }

  bool set_up() override {
    find_weights();
    std::vector<double> size_of_class;
    for (const auto& c : interface_.classes) {  // C^T R C about as stiff as the nodes themselves
      double sum = 0;
      for (const PetscInt i : c.blocks)
        for (int k = 0; k < 3; ++k) sum += diagonal_[3 * static_cast<size_t>(factor_.place(i)) + k];
      size_of_class.push_back(sum / (3. * static_cast<double>(c.blocks.size())));
    }
    int good = factor_.factor(F_, interface_, size_of_class);
    MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
    if (good) {
      good = find_class_matrices(interface_, factor_, size_of_class, is_adaptive_, of_class_);
      list_constraints();
      if (good) good = form_coarse_basis(size_of_class);
    }
    MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
    return good && factor_coarse();
  }

  void apply(Vec b, Vec x) override {
    if (!g_.exists()) g_ = Vector(3 * F_.n_owned());
    scatter(all_, b, local_, INSERT_VALUES, SCATTER_FORWARD);
    const Eigen::Index n_edge = n_ - n_interior_;
    {
      const Values y(local_), e(edge_local_);
      std::fill(y.data() + n_interior_, y.data() + n_, 0.0);
      if (n_ > 0) factor_.forward(0, n_interior_, y.data());
      std::copy(y.data() + n_interior_, y.data() + n_, e.data());
    }
    check(VecCopy(b, g_));
    scatter(edge_, edge_local_, g_, ADD_VALUES, SCATTER_REVERSE);
    scatter(edge_, g_, edge_local_, INSERT_VALUES, SCATTER_FORWARD);
    {
      const Values y(local_), e(edge_local_);
      Eigen::Map<VectorXd> edge(e.data(), n_edge), v(y.data() + n_interior_, n_edge);
      edge = weigh(edge, true);
      v = edge;
      if (n_edge > 0) factor_.forward(n_interior_, n_, y.data()), factor_.backward(n_interior_, n_, y.data());
      const VectorXd primal = solve_coarse(edge);
      for (const Piece& p : pieces_) v.segment(p.from, p.n) += p.Psi * (p.own(primal) - p.C.transpose() * v.segment(p.from, p.n));
      edge = weigh(v, false);
    }
    check(VecSet(x, 0));
    scatter(edge_, edge_local_, x, ADD_VALUES, SCATTER_REVERSE);
    scatter(edge_, x, edge_local_, INSERT_VALUES, SCATTER_FORWARD);
    {
      const Values y(local_), e(edge_local_);
      std::copy(e.data(), e.data() + n_edge, y.data() + n_interior_);
      if (n_ > 0) restore_interior(y.data());
    }
    scatter(all_, local_, x, INSERT_VALUES, SCATTER_REVERSE);
  }

  /// Rigid motions of classes as constraints serve smooth stiffness; where it jumps within subdomains, others are looked for.
  bool strengthen(int iterations, bool failed) override {
    if (is_adaptive_ || (!failed && iterations <= too_many)) return false;
    return is_adaptive_ = true;
  }
  int most_iterations() const override { return is_adaptive_ ? 150 : 60; }
  double undivided_seconds() const override { return coarse_seconds_; }
  std::string name() const override { return is_adaptive_ ? "adaptive BDDC" : "BDDC"; }
  double bytes() const override {
    double sum = factor_.bytes();
    for (const Piece& p : pieces_) sum += 16. * static_cast<double>(p.C.size());
    for (const MatrixXd& w : of_class_.weight) sum += 8. * static_cast<double>(w.size());
    return sum;
  }

 private:
  /// The interface of a connected part of a subdomain: unknowns [from, from + n) of this rank's interface.
  struct Piece {
    Eigen::Index from = 0, n = 0;
    std::vector<int> number;  // of its constraints among all
    MatrixXd C, Psi, coarse;  // (n x constraints), the same, (constraints x constraints)
    VectorXd own(const VectorXd& primal) const {
      VectorXd x(static_cast<Eigen::Index>(number.size()));
      for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = primal[number[k]];
      return x;
    }
  };

  /// y_I := L_II^-T (y_I - L_GI^T y_G)
  void restore_interior(double* y) const { factor_.backward(0, n_interior_, y); }

  static void scatter(VecScatter how, Vec from, Vec to, InsertMode mode, ScatterMode direction) {
    check(VecScatterBegin(how, from, to, mode, direction));
    check(VecScatterEnd(how, from, to, mode, direction));
  }

  void make_scatters() {
    std::vector<PetscInt> index;
    for (PetscInt k = 0; k < F_.n_blocks(); ++k) index.push_back(F_.global(factor_.block(k)));
    const Vector whole(3 * F_.n_owned());
    const auto make = [&](PetscInt first, Vec* local, VecScatter* out) {
      IS from;
      const auto n = static_cast<PetscInt>(index.size()) - first;
      check(VecCreateSeq(PETSC_COMM_SELF, 3 * n, local));
      check(ISCreateBlock(PETSC_COMM_WORLD, 3, n, index.data() + first, PETSC_COPY_VALUES, &from));
      check(VecScatterCreate(whole, from, *local, nullptr, out));
      check(ISDestroy(&from));
    };
    make(0, &local_, &all_);
    make(n_interior_ / 3, &edge_local_, &edge_);
  }

  /// Weights of the interface by the subdomains' diagonals: a stiff side decides.
  void find_weights() {
    diagonal_.assign(n_, 0.0);
    F_.for_each_symmetric_block([&](PetscInt i, PetscInt j, const double* block) {
      if (i == j)
        for (int c = 0; c < 3; ++c) diagonal_[3 * static_cast<size_t>(factor_.place(i)) + c] = std::max(0.0, block[4 * c]);
    });
    const Eigen::Index n_edge = n_ - n_interior_;
    const Eigen::Map<const VectorXd> own(diagonal_.data() + n_interior_, n_edge);
    if (!g_.exists()) g_ = Vector(3 * F_.n_owned());
    check(VecSet(g_, 0));
    {
      const Values e(edge_local_);
      std::copy(own.data(), own.data() + n_edge, e.data());
    }
    scatter(edge_, edge_local_, g_, ADD_VALUES, SCATTER_REVERSE);
    scatter(edge_, g_, edge_local_, INSERT_VALUES, SCATTER_FORWARD);
    const Values e(edge_local_);
    weight_ = own.cwiseQuotient(Eigen::Map<const VectorXd>(e.data(), n_edge));
  }

  /// The pieces' constraints: rigid motions of their classes, then the others.
  void list_constraints() {
    n_constraints_ = interface_.n_constraints + of_class_.n_more;
    const auto& classes = interface_.classes;
    for (Piece& p : pieces_) p.number.clear();
    for (const auto& c : classes)
      for (int m = 0; m < c.q.cols(); ++m) pieces_[c.piece].number.push_back(c.first + m);
    for (size_t k = 0; k < classes.size(); ++k)
      for (int m = 0; m < of_class_.more[k].cols(); ++m)
        pieces_[classes[k].piece].number.push_back(interface_.n_constraints + of_class_.first_more[k] + m);
    for (Piece& p : pieces_) p.C = MatrixXd::Zero(p.n, static_cast<Eigen::Index>(p.number.size()));
    std::vector<Eigen::Index> column(pieces_.size(), 0);
    const auto put = [&](const InterfaceClass& c, const MatrixXd& q) {
      Piece& piece = pieces_[c.piece];
      for (size_t k = 0; k < c.blocks.size() && q.cols() > 0; ++k)
        piece.C.block(3 * factor_.place(c.blocks[k]) - n_interior_ - piece.from, column[c.piece], 3, q.cols()) =
            q.middleRows(3 * static_cast<Eigen::Index>(k), 3);
      column[c.piece] += q.cols();
    };
    for (const auto& c : classes) put(c, c.q);
    for (size_t k = 0; k < classes.size(); ++k) put(classes[k], of_class_.more[k]);
  }

  /// D x, or D^T x.
  VectorXd weigh(const VectorXd& x, bool transposed) const {
    VectorXd y = x.cwiseProduct(weight_), part;
    for (size_t k = 0; k < of_class_.weight.size(); ++k) {
      const MatrixXd& W = of_class_.weight[k];
      if (W.size() == 0) continue;
      const auto& blocks = interface_.classes[k].blocks;
      part.resize(W.rows());
      for (size_t i = 0; i < blocks.size(); ++i)
        part.segment<3>(3 * static_cast<Eigen::Index>(i)) = x.segment<3>(3 * factor_.place(blocks[i]) - n_interior_);
      part = transposed ? VectorXd(W.transpose() * part) : VectorXd(W * part);
      for (size_t i = 0; i < blocks.size(); ++i)
        y.segment<3>(3 * factor_.place(blocks[i]) - n_interior_) = part.segment<3>(3 * static_cast<Eigen::Index>(i));
    }
    return y;
  }

  /// Psi = S^-1 C (C^T S^-1 C)^-1 with the regular S, and the pieces' parts of K_c.
  bool form_coarse_basis(const std::vector<double>& regular) {
    if (!weight_.allFinite()) return false;
    std::vector<double> y(n_, 0.0);
    for (Piece& p : pieces_) {
      const auto from = n_interior_ + static_cast<int>(p.from), to = from + static_cast<int>(p.n);
      const auto n = p.C.cols();
      p.Psi.resize(p.n, n), p.coarse.resize(n, n);
      if (n == 0) continue;
      for (Eigen::Index k = 0; k < n; ++k) {
        std::copy(p.C.col(k).data(), p.C.col(k).data() + p.n, y.begin() + from);
        factor_.forward(from, to, y.data()), factor_.backward(from, to, y.data());
        std::copy(y.begin() + from, y.begin() + to, p.Psi.col(k).data());
      }
      MatrixXd compliance = p.C.transpose() * p.Psi;
      compliance = (0.5 * (compliance + compliance.transpose())).eval();
      const Eigen::LLT<MatrixXd> inverse(compliance);
      if (inverse.info() != Eigen::Success) return false;
      p.coarse = inverse.solve(MatrixXd::Identity(n, n));
      p.Psi = (p.Psi * p.coarse).eval();
    }
    std::vector<Eigen::Index> column(pieces_.size(), 0);
    for (size_t k = 0; k < interface_.classes.size(); ++k) {
      const auto& c = interface_.classes[k];
      for (Eigen::Index m = 0; m < c.q.cols(); ++m) {
        const auto i = column[c.piece]++;
        pieces_[c.piece].coarse(i, i) -= regular[k];
      }
    }
    return std::all_of(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.coarse.allFinite(); });
  }

  /// K_c from all subdomains to all ranks, factored by each.
  bool factor_coarse() {
    if (n_constraints_ == 0) return true;
    std::vector<double> mine, all;
    for (const Piece& p : pieces_)
      for (size_t a = 0; a < p.number.size(); ++a)
        for (size_t b = 0; b < p.number.size(); ++b)
          if (p.number[a] >= p.number[b])
            mine.insert(mine.end(), {static_cast<double>(p.number[a]), static_cast<double>(p.number[b]),
                                     p.coarse(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))});
    int n = static_cast<int>(mine.size());
    std::vector<int> counts(size()), at(size(), 0);
    MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
    for (int r = 1; r < size(); ++r) at[r] = at[r - 1] + counts[r - 1];
    all.resize(static_cast<size_t>(at.back()) + counts.back());
    MPI_Allgatherv(mine.data(), n, MPI_DOUBLE, all.data(), counts.data(), at.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
    const Stopwatch watch(coarse_seconds_);
    std::vector<Eigen::Triplet<double>> entries;
    for (size_t k = 0; k < all.size(); k += 3) entries.emplace_back(static_cast<int>(all[k]), static_cast<int>(all[k + 1]), all[k + 2]);
    Eigen::SparseMatrix<double> K(n_constraints_, n_constraints_);
    K.setFromTriplets(entries.begin(), entries.end());
    coarse_factor_.compute(K);
    return coarse_factor_.info() == Eigen::Success;
  }

  /// All primal unknowns, for forces on the interface.
  VectorXd solve_coarse(const Eigen::Ref<const VectorXd>& edge) {
    VectorXd all = VectorXd::Zero(n_constraints_);
    if (n_constraints_ == 0) return all;
    for (const Piece& p : pieces_) {
      const VectorXd share = p.Psi.transpose() * edge.segment(p.from, p.n);
      for (Eigen::Index k = 0; k < share.size(); ++k) all[p.number[k]] += share[k];
    }
    MPI_Allreduce(MPI_IN_PLACE, all.data(), n_constraints_, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    const Stopwatch watch(coarse_seconds_);
    return coarse_factor_.solve(all);
  }

  const SubdomainMatrix& F_;
  Interface interface_;
  SubdomainFactor factor_;
  std::vector<Piece> pieces_;
  int n_ = 0, n_interior_ = 0;  // unknowns of this rank's subdomains
  std::vector<double> diagonal_;
  VectorXd weight_;
  ClassMatrices of_class_;
  int n_constraints_ = 0;  // of all ranks
  double coarse_seconds_ = 0;
  bool is_adaptive_ = false;  // further constraints are looked for
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> coarse_factor_;
  VecScatter all_ = nullptr, edge_ = nullptr;
  Vec local_ = nullptr, edge_local_ = nullptr;
  Vector g_;
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_bddc(const SubdomainMatrix& F) { return std::make_unique<Bddc>(F); }

}  // namespace hilo::petsc
