// SPDX-License-Identifier: GPL-3.0-or-later
// Models of a scene that differ in the levels of its regions, each run by hilo-solve and kept by content.  Beams of the scene count as
// regions behind those of the mesh; they never stiffen.
#pragma once
#include <functional>
#include <map>
#include <set>

#include "advise/levels.hpp"
#include "advise/processes.hpp"
#include "base/error.hpp"
#include "post/quantity/quantity.hpp"

namespace hilo {

/// What is to be run: `step` scales the time step, `end` is where the run ends, 0: where the scene says  [s]; `modes` scales how many modes
/// the linear regions in `richer` may have; `finer`: on the finer mesh; `is_estimated`: the solver estimates the error of positions too.
struct Request {
  Assignment levels;
  double step = 1, end = 0;
  int modes = 1;
  bool finer = false;
  std::set<size_t> richer{};
  bool is_estimated = false;
  int modes_in(size_t region) const { return richer.contains(region) ? modes : 1; }
};

struct Candidate : Request {
  std::string run;                       // run.h5
  std::string failure;                   // why there is none
  Exit exit = Exit::not_converged;       // with which that one ended
  std::vector<QuantityValue> values;     // of the quantities of a run in time
  double seconds = 0, unknowns = 0;      // seconds of processors
  double cost = 0;                       // seconds of a whole run
  double ended = 0;                      // when it was ended since it cannot serve, its peaks are at least `values`; 0: it was not  [s]
  std::map<size_t, std::string> beyond;  // linear regions that left their range, and what the run said of it
  std::map<size_t, double> doubt;        // of linear regions: what strains of the second degree may change, a share of the answer
  std::map<size_t, double> lack;         // of linear regions: share of the strain that their modes lack
  double positions_off = std::numeric_limits<double>::quiet_NaN();  // by the solver's estimate, a share of the motion
  std::map<size_t, double> energy;                                  // of linear regions: the largest strain energy  [J]
};

class Candidates {
 public:
  struct Options {
    std::string scene, mesh, finer, folder;  // mesh: or nothing; finer: a mesh of the same regions, or nothing
    std::vector<std::string> overrides;
    double tolerance;  // of quantities that say none, relative
    int at_once = 1;
  };
  explicit Candidates(Options options);

  const Scene& scene() const { return scene_; }
  const Mesh& mesh() const { return mesh_.mesh; }
  /// Of regions and beams.
  const std::vector<std::string>& names() const { return names_; }
  bool is_beam(size_t r) const { return r >= mesh().region_name.size(); }
  /// In a scene: region."hull", beam."rail".
  std::string table(size_t r) const;
  /// A number in SI units as the scene writes it.
  double written(std::string_view unit, double si) const { return si / to_si(unit, scene_.units); }
  /// How many vibration modes a linear region has at most, and up to which frequency [Hz].  As the scene says, or `scale` times as many:
  /// frequencies of beams grow with the square of their number, and twice as far, for at least four modes there are in any case.
  struct Modes {
    int most;
    double up_to;
  };
  Modes modes_of(size_t region, int scale) const;
  /// How much smaller the cells of the finer mesh are: the cube root of the ratio of numbers of cells; 0: there is none.
  double refinement() const { return refinement_; }
  /// Regions that share nodes with region r.
  const std::vector<size_t>& neighbours(size_t r) const { return neighbours_[r]; }
  /// Where one of the linear regions that share nodes has stiffening, all of these have; beams never stiffen.
  Assignment consistent(Assignment levels) const;

  /// Regions that a message names in quotation marks: by their names, as parts of a body of several ("a+b"), or by a set of their nodes.
  std::set<size_t> named_in(const std::string& message) const;

  /// Is stiffening cheaper than cells?  It takes about as long as a thousand unknowns of these.
  bool is_large(size_t r) const { return !is_beam(r) && 3 * nodes_[r] > 2000; }

  /// Can a run no longer serve whose peaks are at least these?
  using Beyond = std::function<bool(const std::vector<QuantityValue>& so_far)>;
  /// Runs what is not there yet, several at once; each ends early where `beyond` says so.
  void run(const std::vector<Request>& list, const Beyond& beyond = {});
  /// A run, or the one that is there of the same scene, mesh and levels.
  const Candidate& of(const Request& request, const Beyond& beyond = {});
  /// Has it run, in this call?
  bool knows(const Request& request) const { return done_.contains(job(request).name); }
  /// Seconds that such a run will take, by the unknowns and steps, as far as runs of this scene tell how fast it goes.
  double price(const Request& request) const;
  /// What all runs have cost, also those of earlier calls.
  double spent() const;
  int runs = 0, known = 0;  // in this call, and of those before

 private:
  struct Job {
    std::string name;  // of its files, without ending
    std::vector<std::string> command;
  };
  Job job(const Request& request) const;
  std::vector<QuantityValue> values_of(RunFile& run) const;
  /// Does what there is of a run that has not ended say that it is `beyond`?
  bool is_beyond(const std::string& name, const Beyond& beyond) const;
  void read(Candidate& c, const std::string& name) const;
  bool take(const std::string& name, const Request& request, const Beyond& beyond);
  void fail(const Request& request, const std::string& name, const std::vector<Process>& processes);
  double unknowns(const Request& request) const;
  double work(const Request& request) const;
  const Options o_;
  const Scene scene_;
  const MeshFile mesh_;
  std::string mesh_digest_, finer_digest_;
  double refinement_ = 0;
  std::vector<std::vector<size_t>> neighbours_;
  std::vector<std::string> names_;
  std::vector<double> nodes_;  // by region; a section of a beam counts as two
  std::map<std::string, Candidate> done_;
};

}  // namespace hilo
