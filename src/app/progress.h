// Enters: the state of a render, now and then.
// Leaves: one line on the terminal that tells how far it is.
#pragma once

#include <string>

#include "ajar/render/render.h"

namespace ajar {

struct Progress {
  bool shown = false;     ///< nothing is printed unless
  bool terminal = false;  ///< stderr is one: the line is rewritten in place
  double last = -1;       ///< render seconds of the last line
  ErrorEstimate error;    ///< the last one; costs a pass over the film, so it is made anew only now and then
  double error_spp = 0;   ///< it is of so many samples
  double error_next = 1;  ///< render seconds from which it is made anew
};

/// Takes the line away where stderr is a terminal, so that another can stand in its place.
void clear_line();
/// Puts a line on standard error: in place of the last one where that is a terminal, as much of it as fits in a row.
/// last: all of it, and what follows begins below.
void put_line(std::string line, bool last);
/// "12.3 s", "4:05", "1:02:03".
std::string clock_text(double seconds);
Progress make_progress(bool quiet);
void show(Progress& progress, const RenderOptions& options, const RenderState& state);
/// whole: it was not interrupted.
void finish(Progress& progress, const RenderOptions& options, const RenderState& state, bool whole);

}  // namespace ajar
