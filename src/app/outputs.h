// Enters: a render, running or done.
// Leaves: what ajar render writes of it: image, record, log.
#pragma once

#include <fstream>
#include <optional>

#include "ajar/accel/accel.h"
#include "ajar/film/picture.h"
#include "render_options.h"
#include "summary.h"

namespace ajar {

/// Appends a line to the log whenever time has grown by a tenth since the last one.
struct Log {
  std::ofstream file;
  std::optional<Picture> reference;
  double next = 0.1;

  void write(const RenderState& state, bool last);
};
Log open_log(const RenderArguments&, const Film&);
void write_record(const RenderArguments&, const Run&, const RenderState&);
/// Image, features, techniques and record; prints what it wrote, unless told to be quiet.
void write_outputs(const RenderArguments&, const Scene&, const Accel&, Run&, const RenderState&);

}  // namespace ajar
