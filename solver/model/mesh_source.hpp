// SPDX-License-Identifier: GPL-3.0-or-later
// How mesh, tags and parts files point to one another; shared by the reader of whole files and that of slices.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/mesh.hpp"
#include "model/store.hpp"

namespace hilo {

/// "mesh", "tags", "parts" or "run"; Error for a file that is not ours, too new or incomplete.
std::string checked_format(const Store& store);
/// The file that really holds `/what`: the store's own, or the one it links to.
std::string holder(const Store& store, const std::string& what);
/// Error where `target` is not the file it was when `store` was made from it, with the command that made the store.
void refuse_if_changed(const Store& store, const std::string& what, const std::string& target);
/// Link `/what` of a new file to that of `target`, with the digest of the file as it is now.
void link_to(Store& store, const std::string& what, const std::string& target);
/// The fidelity of each region by its name, from a tags file (`source`: the file that was given).
std::vector<Fidelity> fidelity_by_name(const Store& tags, const std::vector<std::string>& regions, const std::string& source);

/// Names and places of the blocks of nodes, where a mesh has some; and Error where a node's is none of them.
void read_blocks(const Store& mesh, Mesh& m);
void check_blocks(const Store& mesh, const Mesh& m);
/// Numbers of shapes in a mesh file: Error where this program has none of the number, or another shape than the program that wrote the
/// file. `first`: of the first cell of these.
void check_shapes(const Store& mesh, std::span<const std::uint8_t> shapes, std::int64_t first = 0);

/// What write_mesh() publishes, whole on disk under its temporary name.
Store unpublished_mesh(const std::string& path, const Mesh& mesh, const std::vector<std::string>& provenance);

}  // namespace hilo
