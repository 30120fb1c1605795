// Enters: --frames, -D with sweeps, a file of keyframes.
// Leaves: which frames to render, and the scene's parameters at each.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ajar {

/// Frames first to last (counted from 0, both included) of an animation of `count`.
struct FrameRange {
  int first = 0, last = 0, count = 1;
};

/// A parameter over the whole animation. Every key has the same number of values; between keys each value moves on its
/// own.
struct Track {
  struct Key {
    double frame = 0;
    std::vector<double> values;
  };
  std::vector<Key> keys;  ///< in the order of their frames; at least one
  bool smooth = false;    ///< slows down towards keys where it turns or rests; else linear
  std::string file;       ///< of keyframes that it is read from; empty: the user typed it
};

struct Timeline {
  FrameRange frames;
  std::map<std::string, Track> tracks;          ///< by parameter
  std::map<std::string, std::string> constant;  ///< -D name=value
  bool has_time = false;                        ///< of the scene's <animation>s, by the user
  double first_time = 0, last_time = 0;         ///< at the first and the last frame
  std::vector<std::string> notes;               ///< what the user should know, one line each
};

/// frames: "48" (all of 48), "10-20/48" or "7/48"; "10-20" where the keyframes tell how many there are. defines:
/// "door=5..60" sweeps from the first frame to the last, "door=5..60..5" there and back, "door=5..60:smooth" smoothly,
/// "sun=1 2 3..4 5 6" by lists of numbers; other values stay. keyframes: a path, or empty. at: "0..2", or empty. Throws
/// Error.
Timeline make_timeline(const std::string& frames, const std::vector<std::string>& defines, const std::string& keyframes,
                       const std::string& at);
/// The parameters at a frame, as the scene's loader takes them.
std::map<std::string, std::string> parameters_at(const Timeline& timeline, int frame);
/// Whether a parameter has a key at the frame or between it and one beside it, or changes its sign there. Between such
/// frames values neither turn nor pass zero.
bool is_marked(const Timeline& timeline, int frame);
/// Values of a track at a frame: before the first key and after the last they rest.
std::vector<double> values_at(const Track& track, double frame);

}  // namespace ajar
