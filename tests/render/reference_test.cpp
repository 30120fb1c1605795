// Agreement with images of another renderer, where they are at hand.
#include <gtest/gtest.h>

#include <numeric>

#include "ajar/render/render.h"
#include "ajar/scene/load.h"
#include "kit/files.h"
#include "measure.h"

namespace ajar {
namespace {

struct Reference {
  const char* name;
  const char* scene;
  const char* image;
  int width, height, depth;
  const char* integrator;
  uint32_t spp;
  double usual_difference;  ///< of blocks, relative, mostly noise
};
void PrintTo(const Reference& r, std::ostream* out) { *out << r.name; }

constexpr int block = 16;

// Sums over blocks of pixels of the luminance of an image, or of its variance.
std::vector<double> blocks(const Picture& p, const Rgb& weights) {
  std::vector<double> sums(size_t(p.width / block) * size_t(p.height / block), 0.0);
  for (int y = 0; y < p.height / block * block; ++y)
    for (int x = 0; x < p.width / block * block; ++x) {
      const float* v = &p.pixels[3 * (size_t(y) * size_t(p.width) + size_t(x))];
      sums[size_t(y / block) * size_t(p.width / block) + size_t(x / block)] +=
          double(glm::dot(weights, Rgb(v[0], v[1], v[2])));
    }
  return sums;
}

double mean_of(const Picture& p, int channel) {
  double sum = 0;
  for (size_t i = size_t(channel); i < p.pixels.size(); i += 3) sum += p.pixels[i];
  return 3 * sum / double(p.pixels.size());
}

// Standard error of the image's mean, all of its noise being independent from pixel to pixel.
double error_of_mean(const Picture& variance) {
  double sum = 0;
  for (const float v : variance.pixels) sum += v;
  const double n = double(variance.pixels.size());
  return std::sqrt(sum / 3 / (n / 3)) / std::sqrt(n / 3);
}

class AgainstReference : public testing::TestWithParam<Reference> {};

TEST_P(AgainstReference, MeanAndBlocks) {
  const Reference& r = GetParam();
  const std::string scene_path = kit::shared_path(std::string("scenes/") + r.scene);
  const std::string image_path = kit::shared_path(std::string("references/") + r.image);
  AJAR_NEEDS(scene_path);
  AJAR_NEEDS(image_path);
  LoadOptions load;
  load.defines = {{"resx", std::to_string(r.width)}, {"resy", std::to_string(r.height)}};
  const Scene scene = load_scene(scene_path, load);
  const Picture reference = select(read_picture(image_path), {"R", "G", "B"});
  ASSERT_EQ(reference.width, scene.camera.crop_width);
  ASSERT_EQ(reference.height, scene.camera.crop_height);

  RenderOptions options;
  options.integrator = r.integrator;
  options.max_depth = r.depth;
  options.spp = r.spp;
  const RenderState state = rendered(scene, Accel(scene), options);
  const Picture image = develop(state.film);
  const double noise = error_of_mean(variance(state.film));
  for (int c = 0; c < 3; ++c) {
    const double expected = mean_of(reference, c);
    EXPECT_NEAR(mean_of(image, c), expected, 0.005 * expected + 3 * noise) << "channel " << c;
  }

  // No structure: every block of pixels agrees to 3 %, beyond its noise and that of the reference. A splat lands on
  // four pixels, which a sum of variances does not see: hence twice the noise.
  const Rgb y(0.212671f, 0.715160f, 0.072169f);
  const auto ours = blocks(image, y), theirs = blocks(reference, y), squares = blocks(variance(state.film), y * y);
  const double floor = 0.02 * std::accumulate(theirs.begin(), theirs.end(), 0.0) / double(theirs.size());
  int off = 0;
  double lean = 0;
  for (size_t i = 0; i < ours.size(); ++i) {
    const double difference = std::abs(ours[i] - theirs[i]), sigma = 2 * std::sqrt(squares[i]);
    off += difference > 0.03 * theirs[i] + floor + 3 * sigma;
    lean += std::abs(difference) / (theirs[i] + floor) / double(ours.size());
  }
  EXPECT_EQ(off, 0) << "of " << ours.size() << " blocks";
  EXPECT_LT(lean, r.usual_difference) << "mean relative difference of blocks";
  RecordProperty("mean_ratio", std::to_string(mean_of(image, 1) / mean_of(reference, 1)));
  RecordProperty("block_difference", std::to_string(lean));
  RecordProperty("seconds", std::to_string(state.stats.seconds));
}

constexpr Reference references[] = {
    {"cornell_box_bdpt", "cornell-box/scene.xml", "cornell-box-256x256-depth10.exr", 256, 256, 10, "bdpt", 64, 0.01},
    {"cornell_box_path", "cornell-box/scene.xml", "cornell-box-256x256-depth10.exr", 256, 256, 10, "path", 128, 0.01},
    {"veach_mis_bdpt", "veach-mis/scene.xml", "veach-mis-384x216-depth5.exr", 384, 216, 5, "bdpt", 48, 0.01},
    {"veach_mis_path", "veach-mis/scene.xml", "veach-mis-384x216-depth5.exr", 384, 216, 5, "path", 96, 0.01},
    {"veach_ajar_bdpt", "veach-ajar/scene.xml", "veach-ajar-320x180-depth10.exr", 320, 180, 10, "bdpt", 64, 0.03},
    {"cornell_box_guided_bdpt", "cornell-box/scene.xml", "cornell-box-256x256-depth10.exr", 256, 256, 10, "guided-bdpt",
     16, 0.015},
    {"cornell_box_guided_vcm", "cornell-box/scene.xml", "cornell-box-256x256-depth10.exr", 256, 256, 10, "guided-vcm",
     16, 0.015},
    {"cornell_box_vpl", "cornell-box/scene.xml", "cornell-box-256x256-depth10.exr", 256, 256, 10, "vpl", 16, 0.015},
};

INSTANTIATE_TEST_SUITE_P(Mitsuba, AgainstReference, testing::ValuesIn(references),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ajar
