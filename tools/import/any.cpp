// SPDX-License-Identifier: GPL-3.0-or-later
// Which reader reads which file.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "import/imported.hpp"
#include "model/inputs.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

/// Every text in quotes of a script that is the name of a file beside it: gmsh merges or includes it.
std::vector<std::string> files_of_script(const std::string& path) {
  const std::string text = read_text_file(path);
  std::vector<std::string> files;
  for (size_t from = 0; (from = text.find('"', from)) != text.npos;) {
    const size_t to = text.find('"', ++from);
    if (to == text.npos) break;
    const auto file = std::filesystem::path(path).parent_path() / text.substr(from, to - from);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored)) files.push_back(file.string());
    from = to + 1;
  }
  return files;
}

/// A name given to --define that neither the script nor those it includes mention does nothing: it is an error.  Where an included file
/// is not found, nothing is looked into.
void check_defines(const std::string& path, const ImportOptions& options) {
  std::string text;
  std::vector<std::string> files{path};
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string own = read_text_file(files[i]);
    size_t includes = 0;
    for (size_t at = 0; (at = own.find("Include", at)) != own.npos; at += 7) ++includes;
    for (const auto& file : files_of_script(files[i]))
      if (file.ends_with(".geo") && includes > 0) {
        --includes;
        if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
      }
    if (includes > 0) return;
    text += own + '\n';
  }
  std::set<std::string> words;
  std::string word;
  for (const char c : text + ' ')
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      word += c;
    } else {
      if (!word.empty() && !std::isdigit(static_cast<unsigned char>(word[0]))) words.insert(word);
      word.clear();
    }
  for (const auto& [name, value] : options.define)
    if (!words.count(name))
      throw Error("", fmt::format("--define {}: the script has no such name", name),
                  suggest(name, std::vector<std::string>(words.begin(), words.end())), Exit::usage);
}

}  // namespace

Registry<MeshFormat>& mesh_formats() {
  static Registry<MeshFormat> all{"mesh format",
                                  {{".inp", read_inp},
                                   {".bdf", read_bdf},
                                   {".nas", read_bdf},
                                   {".dat", read_bdf},
                                   {".fem", read_bdf},
                                   {".unv", read_unv, false, true},
                                   {".vtk", read_vtk},
                                   {".vtu", read_vtk},
                                   {".msh", read_msh, false, true},
                                   {".mesh", read_medit},
                                   {".med", read_med, false, true},
                                   {".rmed", read_med, false, true},
                                   {".exo", read_exodus, false, true},
                                   {".ex2", read_exodus, false, true},
                                   {".exii", read_exodus, false, true},
                                   {".e", read_exodus, false, true},
                                   {".g", read_exodus, false, true},
                                   {".gen", read_exodus, false, true},
                                   {".stl", read_stl},
                                   {".geo", read_geometry, true},
                                   {".step", read_geometry, true},
                                   {".stp", read_geometry, true},
                                   {".brep", read_geometry, true},
                                   {".iges", read_geometry, true},
                                   {".igs", read_geometry, true}}};
  return all;
}

Imported read_any(const std::string& path, const ImportOptions& options, const Registry<MeshFormat>& formats) {
  namespace fs = std::filesystem;
  if (!fs::exists(path)) throw Error(path, "no such file");
  if (fs::is_directory(path)) throw Error(path, "a folder, not a file");
  if (!fs::is_regular_file(path)) throw Error(path, "a device or pipe, not a file");
  if (!std::ifstream(path)) throw Error(path, "cannot be read", "permissions?", Exit::resources);
  if (fs::file_size(path) == 0) throw Error(path, "an empty file");
  std::string ending = fs::path(path).extension().string();
  if (ending == ".gz") ending = fs::path(path).stem().extension().string() + ".gz";
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".inp.gz") ending = ".inp";
  std::string known;
  for (const auto& f : formats) {
    if (ending == f.name) {
      if (options.size && !f.geometry) throw Error("", fmt::format("--size is for a geometry, {} is a mesh", path), "", Exit::usage);
      if (!options.define.empty() && ending != ".geo") throw Error("", "--define is for .geo scripts", "", Exit::usage);
      if (options.trust && ending != ".geo") throw Error("", "--trust is for .geo scripts: no other file runs anything", "", Exit::usage);
      const bool deck = f.read == read_inp || f.read == read_bdf;
      if (!options.thickness.empty() && !f.geometry && !f.has_surfaces)
        throw Error("", fmt::format("--thickness is for surfaces of a geometry, .msh, .unv, .med or Exodus file, {} is none", path),
                    deck ? "--thicken makes shells of a deck, with the deck's thickness" : "", Exit::usage);
      if (!options.beams.empty() && !f.geometry && f.read != read_msh && f.read != read_medit)
        throw Error("", fmt::format("--beams is for curves of a geometry or .msh file, {} is none", path),
                    deck ? "beams of a deck stand in its scene" : "", Exit::usage);
      if ((options.subcase || options.every_subcase) && !deck)
        throw Error("", fmt::format("--subcase is for a Nastran file, {} is none", path), "", Exit::usage);
      if (options.thicken && !deck)
        throw Error("", fmt::format("--thicken is for shells of a deck, {} is none", path),
                    f.geometry || f.has_surfaces ? "--thickness makes shells of its surfaces" : "", Exit::usage);
      if (!options.define.empty()) check_defines(path, options);
      if (ending == ".geo")
        for (const auto& file : files_of_script(path)) note_input(file);
      return f.read(path, options);
    }
    known += std::string(known.empty() ? "" : " ") + std::string(f.name);
  }
  throw Error(path, fmt::format("no reader for \"{}\" files", ending), "there is one for " + known + " .inp.gz");
}

}  // namespace hilo
