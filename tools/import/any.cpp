// Which reader reads which file.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

struct Format {
  const char* ending;
  Imported (*read)(const std::string&, const ImportOptions&);
};
constexpr Format formats[] = {{".inp", read_inp},  {".bdf", read_bdf},  {".nas", read_bdf},   {".dat", read_bdf},  {".fem", read_bdf},
                              {".vtk", read_vtk},  {".vtu", read_vtk},  {".msh", read_gmsh},  {".unv", read_unv}, {".mesh", read_gmsh},
                              {".stl", read_gmsh}, {".geo", read_gmsh}, {".step", read_gmsh}, {".stp", read_gmsh}, {".brep", read_gmsh},
                              {".iges", read_gmsh}, {".igs", read_gmsh}};

}  // namespace

Imported read_any(const std::string& path, const ImportOptions& options) {
  namespace fs = std::filesystem;
  if (!fs::exists(path)) throw Error(path, "no such file");
  if (fs::is_directory(path)) throw Error(path, "a folder, not a file");
  if (!std::ifstream(path)) throw Error(path, "cannot be read", "permissions?", Exit::resources);
  if (fs::file_size(path) == 0) throw Error(path, "an empty file");
  std::string ending = fs::path(path).extension().string();
  if (ending == ".gz") ending = fs::path(path).stem().extension().string() + ".gz";
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".inp.gz") ending = ".inp";
  std::string known;
  for (const auto& f : formats) {
    if (ending == f.ending) return f.read(path, options);
    known += std::string(known.empty() ? "" : " ") + f.ending;
  }
  throw Error(path, fmt::format("no reader for \"{}\" files", ending), "there is one for " + known + " .inp.gz");
}

}  // namespace hilo
