// Enters: the results of a bench.
// Leaves: error against run time as one SVG picture, a panel per scene, for where no page can be opened.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ajar {

/// relMSE without the worst 0.1 % of pixels over CPU seconds (seconds where those are the budget), both axes
/// logarithmic: the median over the seeds and a band of their spread. Scenes without a sample have no panel; empty
/// where none has one. Throws nlohmann::json::exception where results are not what a bench writes.
std::string curves_svg(const nlohmann::json& results);

}  // namespace ajar
