// ajar report: writes the page of a bench again from its results and images.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "ajar/report/page.h"
#include "commands.h"
#include "say.h"

namespace ajar {

void add_report(CLI::App& app) {
  CLI::App* command = app.add_subcommand("report", "Write report.html again from a bench's results.json and images");
  const auto folder = std::make_shared<std::string>();
  command->add_option("folder", *folder, "Folder that ajar bench wrote")->required();
  command->callback([folder] {
    write_report(read_results(*folder), *folder);
    say(stdout, "{}\n", (std::filesystem::path(*folder) / "report.html").string());
  });
}

}  // namespace ajar
