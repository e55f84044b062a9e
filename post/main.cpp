// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post: pictures, tables and charts of results.
#include <vtkVersionMacros.h>

#include <cstdlib>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "post/commands/commands.hpp"

int main(int argc, char** argv) {
  return hilo::guarded("hilo-post", [&] {
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);  // a run in progress may be read
    const auto app =
        hilo::make_app({"hilo-post", "Pictures, tables and charts of a run, and of a scene before it runs; no display is needed.",
                        "  hilo-post render run.h5 --field von_mises --steps last -o stress.png\n"
                        "  hilo-post movie run.h5 --field displacement -o run.mp4\n"
                        "  hilo-post gload run.h5 --cfc 60 -o gload.csv --png gload.png\n"
                        "  hilo-post series run.h5 --list",
                        hilo::about({"VTK " VTK_VERSION})});
    app->require_subcommand(1);
    const hilo::Command commands[] = {
        hilo::render_command(*app),   hilo::movie_command(*app),  hilo::model_command(*app),  hilo::mesh_command(*app),
        hilo::gload_command(*app),    hilo::injury_command(*app), hilo::series_command(*app), hilo::compare_command(*app),
        hilo::chart_command(*app),    hilo::export_command(*app), hilo::peak_command(*app),   hilo::response_command(*app),
        hilo::quantity_command(*app), hilo::at_command(*app),     hilo::beam_command(*app),   hilo::bend_command(*app)};
    if (!hilo::parse(*app, argc, argv)) return;
    for (const auto& command : commands)
      if (command.app->parsed()) command.run();
  });
}
