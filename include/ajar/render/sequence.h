// Enters: the scene of a frame, and what the frames before it left.
// Leaves: fields to render the frame with, and what the next frame begins with (docs/method.md, "Animation").
#pragma once

#include <optional>

#include "ajar/render/render.h"

namespace ajar {

/// Which of two things the frames of an animation have in common.
struct Coherence {
  bool fields = true;   ///< what frames learned is carried on
  bool numbers = true;  ///< every frame is sampled with the same random numbers
};

struct SequenceOptions {
  Coherence coherence;
  uint32_t teach = 1;   ///< passes that teach the fields of a frame before it is rendered; they are in no image
  uint32_t begin = 16;  ///< the same where nothing is known yet; fewer than 9 are 9
  float forget = 0.8f;  ///< share of the evidence that is kept from frame to frame
};

/// Which files the frames up to one had.
struct FileHistory {
  uint64_t content = 0;  ///< Scene::content of that frame
  uint64_t all = 0;      ///< checksum of the contents of all of them, each change once
  bool operator==(const FileHistory&) const = default;
};
/// With the next frame.
FileHistory with_frame(const FileHistory& before, uint64_t content);

/// What is carried from frame to frame.
struct Carried {
  uint32_t frame = 0;  ///< of which these are the fields
  Fields fields;
  FileHistory files;  ///< that taught them
};

/// The seed of a frame's image, and that of the passes that teach it: independent of each other, so that fields never
/// know the numbers of an image that they guide. Both are every frame's where numbers are, so that fields change as the
/// scene does and not as numbers do.
uint64_t image_seed(const SequenceOptions& sequence, uint64_t seed, uint32_t frame);
uint64_t teaching_seed(const SequenceOptions& sequence, uint64_t seed, uint32_t frame);

/// The fields of a frame: those of the frame before, doubted where the scene moved, and then taught; from nothing where
/// there are none, or after a cut. Where the image has a time limit, lessons take a third of it, more only where fields
/// would be of no use otherwise; else they are the same whatever the clock and the number of threads. options: of the
/// image. Nothing where the monitor said stop. Throws Error where the integrator learns nothing.
std::optional<Fields> teach(const Scene& scene, const Accel& accel, const RenderOptions& options,
                            const SequenceOptions& sequence, const Carried* before, const std::vector<Box>& moved,
                            uint32_t frame, const Monitor& monitor);
/// A render of a guided integrator with these fields, which stay as they are: nothing is recorded. What they know of
/// other lights than the scene's is forgotten. Throws Error where the integrator learns nothing.
RenderState start_with(const Scene& scene, const RenderOptions& options, Fields fields);

/// Files of what is carried; the key names the animation. Throws Error.
void save_carried(const std::string& path, const std::string& key, const Carried& carried);
/// Throws Error where the file is damaged or of another animation.
Carried load_carried(const std::string& path, const std::string& key);

}  // namespace ajar
