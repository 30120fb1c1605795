// Enters: what the user typed.
// Leaves: what it means; Error, with the option and a right example, where it means nothing.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ajar/render/options.h"
#include "ajar/scene/camera.h"
#include "ajar/scene/load.h"

namespace ajar {

/// WIDTHxHEIGHT in place of the camera's own size and crop window.
void set_size(Camera& camera, const std::string& text);
/// Name and value of what stands after -D; forms: how it is written.
std::pair<std::string, std::string> parse_define(const std::string& written, const char* forms = "-D name=value");
/// defines: name=value. at: the time of its animations, where one is given.
LoadOptions load_options(const std::vector<std::string>& defines, bool lenient, std::optional<double> at = {});
/// Throws Error where a time is given, but nothing moves.
void check_time(std::optional<double> at, const Scene& scene);
/// 8M and the like; option names it in messages.
size_t parse_bytes(const std::string& option, const std::string& text);
/// Seconds from 90s, 5m, 1h or a bare number; option names it in messages.
double parse_duration(const std::string& option, const std::string& text);
/// What ends the render, as typed (empty, 0: not given), beside what options hold already: all of it counts. Without
/// any, what the scene asks for.
void set_limits(const std::string& time, const std::string& cpu_time, int spp, const Scene& scene,
                RenderOptions& options);
/// not_given: the scene's own.
void set_max_depth(int max_depth, const Scene& scene, RenderOptions& options);
inline constexpr int not_given = std::numeric_limits<int>::min();
/// Whether there is an integrator of that name.
bool is_integrator(const std::string& name);
/// Throws unless there is.
void check_integrator(const std::string& name);
/// Throws where --guide asks an integrator for what it has not.
void check_guide(const std::string& guide, const std::string& integrator);
/// Integrators that learn fields, for messages.
inline constexpr const char* what_learns = "--integrator guided-bdpt, guided-path, guided-vcm or vpl";
/// What --max-depth means, for help.
inline constexpr const char* max_depth_help =
    "edges of the longest path, up to 4096; 1 sees lights alone, -1 is unlimited: 4096 (default: the scene's)";
/// Of a file's name, in lower case: ".png".
std::string extension_of(const std::string& path);
/// Whether the name ends with .png, in any case.
bool is_png(const std::string& path);
bool is_exr(const std::string& path);
/// Where a name leads to, whatever it is called: links and dots are followed, as far as there is something.
std::string place_of(const std::string& path);
/// Whether both names lead to one file, there or not.
bool is_same_file(const std::string& a, const std::string& b);

}  // namespace ajar
