// Enters: what ajar animate was asked for.
// Leaves: one animation at work: what goes for all of its frames, and which of them are missing.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "animate_options.h"
#include "frames.h"

namespace ajar {

struct Animation {
  const AnimateArguments& arguments;
  Shooting shooting;
  FramePattern pattern, png;
  std::string folder;
  RenderOptions options;                  ///< of frame 0, whichever frames are to be rendered; see frame_options
  int width = 0, height = 0;              ///< of frame 0
  int first_width = 0, first_height = 0;  ///< of the range's first frame
  std::string other_size;                 ///< of the first of them that was seen to have another; for messages
  SequenceOptions sequence;
  std::string options_key;  ///< of the whole animation, without budgets
  std::string key;          ///< the same with the files of its first frame, and whether lessons have a time limit
  std::string other_key;    ///< the same of lessons with one where these have none, or the other way round
  bool carries = false;     ///< fields
  bool lost = false;        ///< fields for a later command: they could not be written
  std::optional<Carried> carried;
  std::set<std::string> noted;  ///< by the loader, and told
  std::vector<int> to_do;
  int done = 0;  ///< of these
  double began = 0;
  double shown = -infinity;
};

/// Throws Error, before any frame is rendered, where one could not be, or a file not be written.
Animation prepare(const AnimateArguments&);
/// Of one frame: budget and depth may be the scene's own, and its parameters may change them from frame to frame.
RenderOptions frame_options(const Animation&, int frame, const Scene&);
/// Everything that decides a frame's pixels.
std::string frame_key(const Animation&, int frame, const Scene&);
/// Sizes may change from frame to frame; a film has one. Throws Error where one is asked for and they do.
void note_size(Animation&, int frame, const Scene&);
void require_one_size(const Animation&);
/// Files beside the frames: fields for a command that goes on, and what .json, .csv and .svg of the figures begin with.
std::string carried_name(const Animation&);
std::string figures_stem(const Animation&);

}  // namespace ajar
