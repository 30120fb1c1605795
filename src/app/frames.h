// Enters: an animation as the user asked for it.
// Leaves: what its frames need one after another: names, scenes, fields; and what is there of them already.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ajar/accel/accel.h"
#include "ajar/render/sequence.h"
#include "ajar/report/sequence.h"
#include "ajar/scene/load.h"
#include "ajar/scene/motion.h"
#include "timeline.h"

namespace ajar {

/// An image's name with a place for the number of the frame: DIR/frame_%04d.exr.
struct FramePattern {
  std::string before, after;  ///< the number
  int digits = 4;
};
/// Throws Error, which begins with the option, unless the name has one %d, in its last part, and ends in .exr.
FramePattern parse_pattern(const std::string& option, const std::string& text);
std::string frame_name(const FramePattern& pattern, int frame);

/// A scene and the ray tracer's structure over it, or over an earlier scene of the same surfaces.
struct Stage {
  std::shared_ptr<const Scene> scene, built_for;
  std::shared_ptr<const Accel> accel;
  std::vector<Box> moved;  ///< since the frame before
  double load_seconds = 0, build_seconds = 0;
  double load_cpu = 0, build_cpu = 0;
};

/// What is needed to set up any frame.
struct Shooting {
  std::string scene_path, size;  ///< size: empty for the scene's own
  bool lenient = false;
  Timeline timeline;
  LoadCache cache;
};

/// The scene's time at a frame; nothing where its <animation>s rest.
std::optional<double> time_at(const Timeline& timeline, int frame);
/// The scene of a frame. Throws Error, with the frame's parameters in it.
std::shared_ptr<const Scene> load_frame(Shooting& shooting, int frame);
/// The stage of a frame; before: that of the frame before, or nullptr. What did not move is not built again.
Stage set_up(Shooting& shooting, int frame, const Stage* before);

/// "door=16.3  time=0.25"
std::string describe(const Timeline& timeline, int frame);

/// The image of a finished frame. Throws Error, which says what to do about a damaged one.
Picture read_frame(const std::string& path);
/// Throws the same where the image's mean is another than the frame's metadata tell, relative to that by more than
/// slack.
void check_mean(const std::string& path, const Picture& image, const Metadata& metadata, double slack);

/// The newest carried fields in a folder that belong to this key and to no frame after the given one, and suit.
std::optional<Carried> find_carried(const std::string& folder, const std::string& key, int last,
                                    const std::function<bool(const Carried&)>& suits);

/// The figures of all frames of the animation that are there. reference: empty for none; of what is missing there no
/// error is known, nor flicker of steps between frames of two sizes. Pixels are read where they are compared alone, or
/// where a frame's file does not tell its mean. key: with which the names of its frames begin, in their files; empty:
/// whatever is there counts.
std::vector<FrameFigures> measure(const FramePattern& pattern, const Timeline& timeline,
                                  const std::optional<FramePattern>& reference, const std::string& key = {});

/// Frames a second, where the user names none.
inline constexpr double usual_fps = 24;
/// Throws Error where the name is none for a film, or not for one of so many frames a second, or ffmpeg is not
/// installed.
void check_video(const std::string& out, double fps);
/// Makes a film of the PNG files of a range. Throws Error, and Interrupted.
void make_video(const FramePattern& png, const FrameRange& frames, double fps, const std::string& out);

}  // namespace ajar
