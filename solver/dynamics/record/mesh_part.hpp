// SPDX-License-Identifier: GPL-3.0-or-later
// What the results file has of nodes and cells: which of them have rows, the fields of those rows, and the sidecar that shows them.
#pragma once
#include <optional>

#include "dynamics/profile.hpp"
#include "dynamics/record/envelope.hpp"
#include "dynamics/record/fields.hpp"

namespace hilo {

class MeshPart {
 public:
  /// `skin`: fields of the nodes on the surfaces of regions alone; `envelope`: and what is largest over all instants.
  MeshPart(const System& system, RunOutput& file, std::vector<std::string> fields, bool skin, bool envelope)
      : system_(system), file_(file), wanted_(std::move(fields)), skin_(skin) {
    if (envelope) envelope_.emplace();
  }
  /// Rows of the fields, followers and, in parallel, parts.  Collective, like all of these.
  void declare();
  void write(double t, const Snapshot& at);
  /// An instant that the envelope is to have seen.
  void envelop(double t, const Snapshot& at);
  void write_envelope();
  /// A file that grows on, without what declare() and later steps write anew.
  void shorten(Store& f) const;
  /// Points ParaView at the arrays of the results file, where it has fields: now and then on the way, and at the end within that file too,
  /// which commits it: `whole` says that every rank has written all of its pieces.
  void show();
  void finish(bool whole);
  void archive(Archive& a);

 private:
  void find_rows();
  void write_from_sources(FieldWriter& to, const Snapshot& at) const;
  void write_followers();
  void write_parts();
  void write_skin(const std::vector<Facet>& facets);
  void write_topology(Store& f);
  void write_xdmf(Store& f);
  void write_vtkhdf(Store& f);
  const System& system_;
  RunOutput& file_;
  std::vector<std::string> wanted_;
  bool skin_;
  std::optional<Slabs> nodes_, cells_;   // rows of the fields
  std::vector<Facet> facets_;            // of the skin,
  std::vector<std::int64_t> skin_node_;  // and its nodes by number
  std::optional<Envelope> envelope_;
  std::vector<std::int64_t> node_row_;  // of local nodes, also those of other ranks; -1: not written
  std::vector<std::unique_ptr<FieldSource>> sources_;
  std::int64_t topology_entries_ = 0, topology_cells_ = 0;  // of XDMF's list
  std::vector<double> times_;
  double next_xdmf_ = wall_clock() + 1;
};

}  // namespace hilo
