// SPDX-License-Identifier: GPL-3.0-or-later
// The subcommands of hilo-post: each adds its options to the app and is run after the command line was read.
#pragma once
#include <functional>

namespace CLI {
class App;
}

namespace hilo {

struct Command {
  CLI::App* app;
  std::function<void()> run;
};

Command at_command(CLI::App& app);
Command bend_command(CLI::App& app);
Command beam_command(CLI::App& app);
Command render_command(CLI::App& app);
Command movie_command(CLI::App& app);
Command model_command(CLI::App& app);
Command mesh_command(CLI::App& app);
Command gload_command(CLI::App& app);
Command injury_command(CLI::App& app);
Command peak_command(CLI::App& app);
Command quantity_command(CLI::App& app);
Command response_command(CLI::App& app);
Command series_command(CLI::App& app);
Command compare_command(CLI::App& app);
Command chart_command(CLI::App& app);
Command export_command(CLI::App& app);

}  // namespace hilo
