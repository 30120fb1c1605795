#include "frames.h"

#include <gtest/gtest.h>

#include "ajar/scene/motion.h"

namespace ajar {

Picture last_frame(std::span<const Scene> frames, const RenderOptions& options, const SequenceOptions& sequence,
                   const std::function<void(Carried&)>& between) {
  std::optional<Carried> carried;
  const auto last = uint32_t(frames.size()) - 1;
  for (uint32_t f = 0; f <= last; ++f) {
    const Accel accel(frames[f]);
    const std::vector<Box> moved = carried ? find_motion(frames[f - 1], frames[f]) : std::vector<Box>();
    std::optional<Fields> fields =
        teach(frames[f], accel, options, sequence, carried ? &*carried : nullptr, moved, f, {});
    carried = Carried{f, std::move(*fields)};
    if (between) between(*carried);
  }
  RenderOptions image = options;
  image.seed = image_seed(sequence, options.seed, last);
  RenderState state = start_with(frames[last], image, carried->fields);
  render(frames[last], Accel(frames[last]), image, state, {});
  EXPECT_EQ(state.stats.rejected, 0u);
  EXPECT_EQ(state.film.passes, image.spp);
  EXPECT_EQ(state.learning.fields.generation, carried->fields.generation) << "fields of an image stay as they are";
  return develop(state.film);
}

}  // namespace ajar
