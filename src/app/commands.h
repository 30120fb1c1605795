// Enters: the command line.
// Leaves: one subcommand each, registered with its options; its callback does the work and throws ajar::Error.
#pragma once

namespace CLI {
class App;
}

namespace ajar {

void add_render(CLI::App& app);
void add_animate(CLI::App& app);
void add_compare(CLI::App& app);
void add_bench(CLI::App& app);
void add_fields(CLI::App& app);
void add_plan(CLI::App& app);
void add_report(CLI::App& app);

}  // namespace ajar
