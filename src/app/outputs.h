// Enters: a render, asked for, running or done.
// Leaves: what ajar render writes of it: image, record, log; before it, whether that can be written.
#pragma once

#include <fstream>
#include <functional>
#include <optional>

#include "ajar/accel/accel.h"
#include "ajar/film/picture.h"
#include "render_options.h"
#include "summary.h"

namespace ajar {

/// Appends a line to the log whenever time has grown by a tenth since the last one.
struct Log {
  std::string path;
  std::ofstream file;
  std::string waiting;  ///< lines, while what an earlier render left in the file is worth more
  bool spares = false;  ///< whether there is such: until the first line after a minute, or the last one
  std::optional<Picture> reference;
  std::string fault;  ///< of the first line that could not be written; none follow it
  double next = 0.1;

  void write(const RenderState& state, bool last);
};
/// The image to measure errors against; throws Error unless it is fit for that.
Picture read_reference(const std::string& path, const Camera&);
/// The same, if there is to be one.
std::optional<Picture> read_reference(const RenderArguments&, const Camera&);
/// A log that goes on is added to.
Log open_log(const RenderArguments&, std::optional<Picture> reference);
/// Throws Error where a name is wrong, or of two things at once, or cannot be written.
void check_outputs(const RenderArguments&);
/// The same, where an output is one of the files that the scene was read from.
void check_apart(const RenderArguments&, const Scene&);
/// Throws Error where the name of an image's record is that of a file which is none.
void check_record(const std::string& image);
void write_record(const RenderArguments&, const Run&, const RenderState&);
/// Image, features and record; prints what it wrote, unless told to be quiet.
void write_image(const RenderArguments&, const Scene&, const Accel&, Run&, const RenderState&);
/// Name of the tonemapped image beside it; empty where there is to be none, or the image itself is one.
std::string png_beside(const RenderArguments&);
void write_png_beside(const RenderArguments&, const RenderState&);
/// Of rendering, from save to save.
inline constexpr double save_seconds = 60;
/// Saves the state every minute of rendering. Where that fails the render goes on; it is said once.
struct Saver {
  std::string path, key;  ///< no path: nothing is saved
  double saved = 0;       ///< render seconds
  bool failed = false;

  void save(const RenderState& state);
};
/// Calls all of them: what fails does not keep the rest from being written. Throws the last error, and prints others.
void write_each(const std::vector<std::function<void()>>& writes);

}  // namespace ajar
