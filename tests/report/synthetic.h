// Enters: a folder.
// Leaves: results and images like those of a bench, made up by formulas, so that every figure of them is known.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace ajar::test {

/// Size of the images of the first scene.
inline constexpr int synthetic_width = 96, synthetic_height = 54;

/// Writes images below the folder and gives the results: a scene with everything (four methods, three seeds, strategies
/// and a field), one whose names try to break out of the page, with one seed and without reference, and one left out.
nlohmann::json make_synthetic(const std::filesystem::path& folder);

}  // namespace ajar::test
