// Enters: the results of a bench and the folder that holds the images they name.
// Leaves: report.html in that folder: one file that needs no other, and no network; and its curves alone, curves.svg.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace ajar {

/// Writes dir/report.html and dir/curves.svg (curves.h), aside and renamed, from results of format 1 (docs/report.md)
/// and the images whose paths, relative to dir, they name. HDR images are embedded as half floats, (s,t) images reduced
/// to at most 160 pixels of width; PNG files as they are. Throws Error that names dir/results.json and its element, or
/// the image.
void write_report(const nlohmann::json& results, const std::filesystem::path& dir);

/// What dir/results.json holds. Throws Error where it cannot be read or is no JSON.
nlohmann::json read_results(const std::filesystem::path& dir);

}  // namespace ajar
