// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/class_matrices.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "linear/lapack.hpp"
#include "linear/petsc/session.hpp"

namespace hilo::petsc {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Blocks of a class up to which it gets a dense matrix as weight (26 MB).
constexpr size_t largest_class = 600;
/// Unknowns of a piece's interface up to which its inverse is formed (200 MB).
constexpr int largest_interface = 5000;
/// Jumps whose energy weighing may raise by more become constraints.
constexpr double worst_ratio = 1.8;

/// Eigenvectors of a symmetric matrix with eigenvalues above `least`.
MatrixXd upper_eigenvectors(MatrixXd A, double least) {
  const int n = static_cast<int>(A.rows());
  const double most = 1e300, accuracy = 0;
  int found = 0, size = -1, integers = -1, info = 0, first_integers;
  double first_size;
  VectorXd value(n);
  MatrixXd vector(n, n);
  std::vector<int> support(2 * static_cast<size_t>(n));
  const auto call = [&](double* work, int* integer) {
    dsyevr_("V", "V", "L", &n, A.data(), &n, &least, &most, nullptr, nullptr, &accuracy, &found, value.data(), vector.data(), &n,
            support.data(), work, &size, integer, &integers, &info);
  };
  call(&first_size, &first_integers);
  size = static_cast<int>(first_size), integers = first_integers;
  std::vector<double> work(size);
  std::vector<int> integer(integers);
  call(work.data(), integer.data());
  return info == 0 ? MatrixXd(vector.leftCols(found)) : MatrixXd(n, 0);
}

/// Jumps v across a class, free of rigid motions q, with  v^T A v > worst_ratio v^T B v,  as constraints A v:  A^-1 = sum S_F^-1 of the
/// holders (all else held), B^-1 = sum (S^-1)_F (all else free).  A is what weighing the jump may cost, B what making it costs at least.
MatrixXd stiff_jumps(const MatrixXd& A_inverse, MatrixXd B_inverse, const MatrixXd& q) {
  const auto n = A_inverse.rows();
  const Eigen::LLT<MatrixXd> inverse(A_inverse);
  const MatrixXd free = B_inverse * q;
  const Eigen::LLT<MatrixXd> rigid(q.transpose() * free);
  if (inverse.info() != Eigen::Success || rigid.info() != Eigen::Success) return MatrixXd(n, 0);
  B_inverse -= free * rigid.solve(free.transpose());
  // A = L^-T L^-1 with A^-1 = L L^T;  L^-1 B^-1 L^-T y = ratio y,  A v = L^-T y
  MatrixXd M = inverse.matrixL().solve(B_inverse);
  M = inverse.matrixL().solve(M.transpose().eval()).eval();
  MatrixXd more = inverse.matrixU().solve(upper_eigenvectors(M, worst_ratio));
  if (more.cols() == 0) return more;
  more -= (q * (q.transpose() * more)).eval();
  for (Eigen::Index k = 0; k < more.cols(); ++k) more.col(k).normalize();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(more);
  qr.setThreshold(1e-6);
  return qr.householderQ() * MatrixXd::Identity(n, qr.rank());
}

/// M M^T, by the BLAS, whose products are several times as fast as Eigen's without wide vectors.
MatrixXd gram(const MatrixXd& M) {
  const int n = static_cast<int>(M.rows()), m = static_cast<int>(M.cols());
  MatrixXd G = MatrixXd::Zero(n, n);
  if (n > 0 && m > 0) lapack::gram(n, m, M.data(), G.data());
  G.triangularView<Eigen::StrictlyUpper>() = G.transpose();
  return G;
}

/// A symmetric positive definite matrix, factored.
class Positive {
 public:
  explicit Positive(MatrixXd A)
      : L_(std::move(A)), good_(lapack::factor(static_cast<int>(L_.rows()), L_.data(), static_cast<int>(L_.rows()))) {}
  bool good() const { return good_; }
  /// A^-1 X
  MatrixXd solve(MatrixXd X) const {
    lapack::solve(static_cast<int>(L_.rows()), static_cast<int>(X.cols()), L_.data(), X.data());
    return X;
  }

 private:
  MatrixXd L_;
  bool good_;
};

std::vector<int> unknowns_of(const InterfaceClass& c, const SubdomainFactor& factor) {
  std::vector<int> unknowns;
  for (const PetscInt i : c.blocks)
    for (int a = 0; a < 3; ++a) unknowns.push_back(3 * factor.place(i) + a);
  return unknowns;
}

/// (S^-1)_F of a piece's classes, S but for a trace without what made it regular.
void find_compliances(const Interface& interface, const SubdomainFactor& factor, const std::vector<double>& regular, int piece,
                      std::vector<MatrixXd>& out) {
  constexpr double left = 1e-3;
  const auto& classes = interface.classes;
  const MatrixXd root = factor.inverse_root(piece, largest_interface);
  if (root.size() == 0) return;
  std::vector<size_t> own;
  Eigen::Index n = 0;
  for (size_t k = 0; k < classes.size(); ++k)
    if (classes[k].piece == piece) own.push_back(k), n += classes[k].q.cols();
  MatrixXd C = MatrixXd::Zero(root.rows(), n);
  VectorXd removed(n);
  Eigen::Index column = 0;
  for (const size_t k : own) {
    const auto unknowns = unknowns_of(classes[k], factor);
    for (size_t i = 0; i < unknowns.size(); ++i)
      C.block(unknowns[i] - factor.begin(piece), column, 1, classes[k].q.cols()) = classes[k].q.row(static_cast<Eigen::Index>(i));
    removed.segment(column, classes[k].q.cols()).setConstant((1 - left) * regular[k]);
    column += classes[k].q.cols();
  }
  C = (root * C).eval();
  MatrixXd rest = -(C.transpose() * C);
  rest.diagonal() += removed.cwiseInverse();
  const Eigen::LLT<MatrixXd> update(rest);  // Woodbury's formula
  if (update.info() != Eigen::Success) return;
  for (const size_t k : own) {
    if (classes[k].blocks.size() > largest_class) continue;
    const auto unknowns = unknowns_of(classes[k], factor);
    MatrixXd columns(root.rows(), static_cast<Eigen::Index>(unknowns.size()));
    for (size_t i = 0; i < unknowns.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = root.col(unknowns[i] - factor.begin(piece));
    const MatrixXd U = columns.transpose() * C;
    out[k] = columns.transpose() * columns + U * update.solve(U.transpose());
  }
}

/// Calls `visit(rank)` for each rank but this one that has the class, once.
template <class Visit>
void for_other_ranks(const InterfaceClass& c, const Visit& visit) {
  int last = rank();
  for (const auto& holder : c.holders) {
    if (holder.rank != rank() && holder.rank != last) visit(holder.rank);
    last = holder.rank;
  }
}

/// Takes matrices out of what the ranks sent, in the order in which they were put in.
class Inbox {
 public:
  explicit Inbox(const std::vector<std::vector<double>>& send) : got_(comm().exchange(send)), at_(got_.size(), 0) {}
  double number(int from) { return got_[from][at_[from]++]; }
  MatrixXd matrix(int from, Eigen::Index rows, Eigen::Index columns) {
    const double* data = got_[from].data() + at_[from];
    at_[from] += static_cast<size_t>(rows * columns);
    return Eigen::Map<const MatrixXd>(data, rows, columns);
  }

 private:
  std::vector<std::vector<double>> got_;
  std::vector<size_t> at_;
};

void put(std::vector<double>& to, const MatrixXd& M) { to.insert(to.end(), M.data(), M.data() + M.size()); }

}  // namespace

bool find_class_matrices(const Interface& interface, const SubdomainFactor& factor, const std::vector<double>& regular,
                         bool more_constraints, ClassMatrices& out) {
  const auto& classes = interface.classes;
  const size_t n = classes.size();
  std::vector<MatrixXd> own(n), inverse(n);  // S_F; (S^-1)_F of the regular S, empty where not formed
  std::vector<std::vector<double>> send(size()), to_leader(size());
  for (size_t k = 0; k < n; ++k) {
    if (classes[k].blocks.size() > largest_class) continue;
    const MatrixXd rows = factor.schur_rows(classes[k].piece, unknowns_of(classes[k], factor));
    own[k] = gram(rows) - regular[k] * classes[k].q * classes[k].q.transpose();
    for_other_ranks(classes[k], [&](int r) { put(send[r], own[k]); });
  }
  if (more_constraints)
    for (int p = 0; p < interface.n_pieces; ++p) find_compliances(interface, factor, regular, p, inverse);
  for (size_t k = 0; k < n && more_constraints; ++k)
    if (const int leader = classes[k].holders[0].rank; own[k].size() > 0 && leader != rank()) {
      to_leader[leader].push_back(inverse[k].size() > 0);
      put(to_leader[leader], inverse[k]);
    }
  Inbox schur(send), compliance(to_leader);
  out.weight.assign(n, MatrixXd()), out.more.assign(n, MatrixXd()), out.first_more.assign(n, 0);
  bool good = true;
  int mine = 0;
  for (size_t k = 0, next; k < n; k = next) {  // classes [k, next) are one, seen from several pieces of this rank
    for (next = k + 1; next < n && classes[next].first == classes[k].first;) ++next;
    const auto m = own[k].rows();
    if (m == 0) continue;
    const auto& c = classes[k];
    const bool leads = more_constraints && c.holders[0].rank == rank();
    MatrixXd all = MatrixXd::Zero(m, m), A_inverse = all, B_inverse = all;
    bool formed = leads;
    size_t at = k;
    for (const auto& holder : c.holders) {  // in the same order on all of them
      const bool here = holder.rank == rank();
      const MatrixXd S = here ? own[at] : schur.matrix(holder.rank, m, m);
      all += S;
      if (leads) {
        const bool has = here ? inverse[at].size() > 0 : compliance.number(holder.rank) > 0;
        if (has) B_inverse += here ? inverse[at] : compliance.matrix(holder.rank, m, m);
        formed = formed && has;
        if (formed) A_inverse += (S + S.trace() / static_cast<double>(m) * c.q * c.q.transpose()).llt().solve(MatrixXd::Identity(m, m));
      }
      at += here;
    }
    if (formed) out.more[k] = stiff_jumps(A_inverse, B_inverse, c.q), mine += static_cast<int>(out.more[k].cols());
    const Positive total(std::move(all));
    good = good && total.good();
    for (size_t i = k; good && i < next; ++i) out.weight[i] = total.solve(own[i]);
  }
  if (!more_constraints) return good;
  int before = static_cast<int>(comm().before(mine));
  out.n_more = static_cast<int>(comm().sum(std::int64_t{mine}));
  std::vector<std::vector<double>> tell(size());
  for (size_t k = 0; k < n; ++k) {
    if (k > 0 && classes[k].first == classes[k - 1].first) {
      out.more[k] = out.more[k - 1], out.first_more[k] = out.first_more[k - 1];
      continue;
    }
    if (own[k].size() == 0 || classes[k].holders[0].rank != rank()) continue;
    out.first_more[k] = before;
    before += static_cast<int>(out.more[k].cols());
    for_other_ranks(classes[k], [&](int r) {
      tell[r].push_back(static_cast<double>(out.more[k].cols())), tell[r].push_back(out.first_more[k]);
      put(tell[r], out.more[k]);
    });
  }
  Inbox told(tell);
  for (size_t k = 0; k < n; ++k) {
    const int leader = classes[k].holders[0].rank;
    if (own[k].size() == 0 || leader == rank()) continue;
    if (k > 0 && classes[k].first == classes[k - 1].first) {
      out.more[k] = out.more[k - 1], out.first_more[k] = out.first_more[k - 1];
      continue;
    }
    const auto columns = static_cast<Eigen::Index>(told.number(leader));
    out.first_more[k] = static_cast<int>(told.number(leader));
    out.more[k] = told.matrix(leader, own[k].rows(), columns);
  }
  return good;
}

}  // namespace hilo::petsc
