// Textures: what a look-up gives at corners, edges and beyond, and its derivatives.
#include <gtest/gtest.h>

#include "ajar/scene/texture.h"
#include "lights.h"

namespace ajar {
namespace {

const Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::zero, Wrap::one};

// A scene with one bitmap (image 0, texture 0) of three columns and two rows; top row 1 2 3, bottom row 4 5 6.
struct Fixture {
  Scene scene;
  Slot slot;
  Texture& texture() { return scene.textures[0]; }

  Fixture() {
    Image image;
    image.width = 3, image.height = 2, image.channels = 1;
    image.floats = {1, 2, 3, 4, 5, 6};
    image.alpha = {0, 51, 102, 153, 204, 255};
    scene.images.push_back(image);
    scene.textures.emplace_back();
    texture().image = 0;
    slot.texture = 0;
  }
  float at(float u, float v) const {
    Surface s;
    s.uv = {u, v};
    return eval_scalar(scene, slot, s);
  }
  Vec2 gradient(float u, float v) const {
    Surface s;
    s.uv = {u, v};
    return eval_gradient(scene, slot, s);
  }
};

TEST(Texture, TexelCentresAreExact) {
  Fixture f;
  for (const bool nearest : {false, true}) {
    f.texture().nearest = nearest;
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x)
        EXPECT_NEAR(f.at((float(x) + 0.5f) / 3, 0.75f - 0.5f * float(y)), 1 + x + 3 * y, 1e-5f);  // v runs upwards
  }
  f.texture().flip_v = false;
  EXPECT_NEAR(f.at(0.5f / 3, 0.25f), 1, 1e-5f);
}

TEST(Texture, IsBilinearBetween) {
  Fixture f;
  EXPECT_NEAR(f.at(1.0f / 3, 0.75f), 1.5f, 1e-5f);
  EXPECT_NEAR(f.at(1.0f / 3, 0.5f), 3, 1e-5f);
  EXPECT_NEAR(f.at(0.5f, 0.5f), 3.5f, 1e-5f);
}

TEST(Texture, WrapsAsItIsTold) {
  const float right[] = {2, 3, 3, 1.5f, 2};  // at the middle of the top row's right edge: 3 against 1, 3, 3, 0, 1
  for (size_t i = 0; i < 5; ++i) {
    Fixture f;
    f.texture().wrap_u = f.texture().wrap_v = wraps[i];
    EXPECT_NEAR(f.at(1, 0.75f), right[i], 1e-5f) << i;
    EXPECT_NEAR(f.at(0, 0.75f), wraps[i] == Wrap::repeat ? 2 : wraps[i] == Wrap::zero ? 0.5f : 1, 1e-5f) << i;
  }
  Fixture f;
  EXPECT_NEAR(f.at(0.5f / 3 + 5, 0.75f - 3), 1, 1e-4f);
  f.texture().wrap_u = Wrap::mirror;
  EXPECT_NEAR(f.at(2 - 0.5f / 3, 0.75f), 1, 1e-5f);
  EXPECT_NEAR(f.at(-0.5f / 3, 0.75f), 1, 1e-5f);
  EXPECT_NEAR(f.at(1 + 0.5f / 3, 0.75f), 3, 1e-5f);
  f.texture().wrap_u = Wrap::clamp;
  EXPECT_NEAR(f.at(17, 0.75f), 3, 1e-5f);
  EXPECT_NEAR(f.at(-17, 0.75f), 1, 1e-5f);
  f.texture().wrap_u = Wrap::zero;
  EXPECT_EQ(f.at(1.5f, 0.75f), 0);
  EXPECT_EQ(f.at(-0.5f, 0.75f), 0);
  f.texture().wrap_u = Wrap::one;
  EXPECT_EQ(f.at(1.5f, 0.75f), 1);
}

TEST(Texture, AnyCoordinateIsSafe) {
  for (const Wrap wrap : wraps)
    for (const bool nearest : {false, true}) {
      Fixture f;
      f.texture().wrap_u = f.texture().wrap_v = wrap;
      f.texture().nearest = nearest;
      for (const float u :
           {0.0f, 1.0f, -0.0f, one_minus_epsilon, -1e-9f, 1e-30f, 1e8f, -1e8f, 1e20f, -3e38f, 2.0f, -1.0f})
        for (const float v : {0.0f, 1.0f, -1e-9f, 1e30f, -1e9f}) {
          EXPECT_TRUE(f.at(u, v) >= 0 && f.at(u, v) <= 6) << u << " " << v;
          EXPECT_TRUE(std::isfinite(f.gradient(u, v).x + f.gradient(u, v).y));
        }
    }
}

TEST(Texture, ChannelsAndAlpha) {
  Fixture f;
  f.texture().channel = Channel::alpha;
  EXPECT_NEAR(f.at(0.5f, 0.75f), 0.2f, 1e-5f);
  f.scene.images[0].alpha.clear();
  EXPECT_EQ(f.at(0.5f, 0.75f), 1);
  f.scene.images[0] = kit::float_image(3, 2, [](int x, int) { return float(x + 1); });
  f.texture().channel = Channel::blue;
  EXPECT_NEAR(f.at(0.5f, 0.75f), 2 * 0.6f, 1e-5f);
  f.texture().channel = Channel::color;
  EXPECT_NEAR(f.at(0.5f, 0.75f), 2 * luminance(Rgb(1, 0.8f, 0.6f)), 1e-5f);
}

TEST(Texture, UvTransform) {
  Fixture f;
  f.texture().to_uv = Mat3(2, 0, 0, 0, 3, 0, 0.25f, 0.5f, 1);  // columns: u times 2, v times 3, and a shift
  EXPECT_NEAR(f.at(0.1f, 0.2f), Fixture().at(0.45f, 1.1f), 1e-4f);
}

// Red heights through a red factor are seen as they are, and slope as they are.
TEST(Texture, GradientsOfProductsOfColours) {
  Fixture f;
  f.scene.images[0].channels = 3;
  f.scene.images[0].floats = {1, 0, 5, 2, 0, 4, 3, 0, 3, 4, 0, 2, 5, 0, 1, 6, 0, 0};
  f.scene.images[0].alpha.clear();
  for (const TextureKind kind : {TextureKind::scale, TextureKind::average}) {
    f.scene.textures.resize(2);
    f.scene.textures[1].kind = kind;
    f.scene.textures[1].color0.texture = 0;
    f.scene.textures[1].color1 = Slot(Rgb(1, 0, 0));
    f.slot.texture = 1;
    const float h = 1e-3f;
    const Vec2 g = f.gradient(0.4f, 0.5f);
    EXPECT_NEAR(g.x, (f.at(0.4f + h, 0.5f) - f.at(0.4f - h, 0.5f)) / (2 * h), 2e-3f) << int(kind);
    EXPECT_NEAR(g.y, (f.at(0.4f, 0.5f + h) - f.at(0.4f, 0.5f - h)) / (2 * h), 2e-3f) << int(kind);
  }
}

// Against differences of eval, within one texel cell; every wrap, transform and nesting.
TEST(Texture, GradientIsTheDerivative) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::zero, Wrap::one})
    for (const bool flip : {false, true}) {
      Fixture f;
      f.texture().wrap_u = f.texture().wrap_v = wrap;
      f.texture().flip_v = flip;
      f.texture().to_uv = Mat3(0.8f, 0.3f, 0, -0.2f, 0.9f, 0, 0.1f, 0.05f, 1);
      f.scene.textures.emplace_back();
      f.scene.textures[1].kind = TextureKind::scale;
      f.scene.textures[1].color0.texture = 0;
      f.scene.textures[1].color1.texture = 0;
      for (const uint32_t id : {0u, 1u}) {
        f.slot.texture = id;
        for (uint32_t i = 0; i < 200; ++i) {
          const Vec2 uv = 3.0f * kit::random2(i, 1) - 1.0f;
          const float h = 1e-3f;
          const Vec2 right(f.at(uv.x + h, uv.y) - f.at(uv.x, uv.y), f.at(uv.x, uv.y + h) - f.at(uv.x, uv.y));
          const Vec2 left(f.at(uv.x, uv.y) - f.at(uv.x - h, uv.y), f.at(uv.x, uv.y) - f.at(uv.x, uv.y - h));
          if (glm::distance(left, right) > 0.02f * h * 100) continue;  // an edge between cells
          const Vec2 g = f.gradient(uv.x, uv.y), slope = (right + left) / (2 * h);
          EXPECT_NEAR(g.x, slope.x, 0.02f * (1 + std::abs(slope.x))) << int(wrap) << " " << uv.x << " " << uv.y;
          EXPECT_NEAR(g.y, slope.y, 0.02f * (1 + std::abs(slope.y))) << int(wrap) << " " << uv.x << " " << uv.y;
        }
      }
    }
}

TEST(Texture, Checkerboard) {
  Fixture f;
  f.texture().kind = TextureKind::checkerboard;
  f.texture().color0 = Slot(0.8f), f.texture().color1 = Slot(0.2f);
  EXPECT_EQ(f.at(0.25f, 0.25f), 0.8f);
  EXPECT_EQ(f.at(0.75f, 0.75f), 0.8f);
  EXPECT_EQ(f.at(0.75f, 0.25f), 0.2f);
  EXPECT_EQ(f.at(-0.25f, 0.25f), 0.2f);
  EXPECT_EQ(f.at(7.25f, -3.75f), 0.8f);
  f.texture().to_uv = Mat3(20, 0, 0, 0, 80, 0, 0, 0, 1);
  EXPECT_EQ(f.at(0.026f, 0.001f), 0.2f);
  EXPECT_NEAR(mean(f.scene, f.slot).x, 0.5f, 1e-6f);
}

TEST(Texture, ScaleMultiplies) {
  Fixture f;
  f.scene.textures.emplace_back();
  f.scene.textures[1].kind = TextureKind::scale;
  f.scene.textures[1].color0.texture = 0;
  f.scene.textures[1].color1 = Slot(0.5f);
  f.slot.texture = 1;
  EXPECT_NEAR(f.at(0.5f, 0.75f), 1, 1e-6f);
  EXPECT_NEAR(mean(f.scene, f.slot).x, 1.75f, 1e-6f);
}

TEST(Texture, LimitKeepsFromZeroToOne) {
  Fixture f;
  f.scene.textures.emplace_back();
  f.scene.textures[1].kind = TextureKind::limit;
  f.scene.textures[1].color0 = Slot(Rgb(-1, 0.5f, 2));
  f.slot.texture = 1;
  EXPECT_EQ(eval(f.scene, f.slot, {}), Rgb(0, 0.5f, 1));
  EXPECT_EQ(mean(f.scene, f.slot), Rgb(0, 0.5f, 1));
  EXPECT_EQ(maximum(f.scene, f.slot).z, 1);
}

TEST(Texture, MaximumOfAll) {
  Fixture f;
  EXPECT_EQ(maximum(f.scene, f.slot), Rgb(6));
  f.texture().channel = Channel::alpha;
  EXPECT_EQ(maximum(f.scene, f.slot), Rgb(1));
  f.texture().channel = Channel::color;
  Image bytes;
  bytes.width = 2, bytes.height = 1, bytes.channels = 3;
  bytes.bytes = {0, 10, 200, 7, 20, 100};
  for (int i = 0; i < 256; ++i) bytes.decode[i] = float(i) / 256;
  f.scene.images.push_back(bytes);
  f.texture().image = 1;
  EXPECT_EQ(maximum(f.scene, f.slot), Rgb(7, 20, 200) / 256.0f);
  f.texture().channel = Channel::green;
  EXPECT_EQ(maximum(f.scene, f.slot), Rgb(20) / 256.0f);
  f.texture().channel = Channel::color;
  f.texture().image = 0;
  f.texture().wrap_u = Wrap::one;
  f.scene.textures.emplace_back();
  f.scene.textures[1].kind = TextureKind::scale;
  f.scene.textures[1].color0.texture = 0;
  f.scene.textures[1].color1 = Slot(Rgb(0.5f, 1, 2));
  f.scene.textures.emplace_back();
  f.scene.textures[2].kind = TextureKind::grid;
  f.scene.textures[2].color0.texture = 1;
  f.scene.textures[2].color1 = Slot(Rgb(4));
  f.slot.texture = 2;
  EXPECT_EQ(maximum(f.scene, f.slot), Rgb(4, 6, 12));
  f.texture().kind = TextureKind::mesh_attribute;
  f.texture().attribute = "vertex_color";
  EXPECT_EQ(maximum(f.scene, f.slot).x, infinity);
  Mesh mesh;
  mesh.colors = {Rgb(3, 0, 0), Rgb(0, 7, 0)};
  EXPECT_EQ(maximum(f.scene, f.slot, &mesh), Rgb(4, 7, 4));
}

TEST(Texture, MeanOfBitmapIsExact) {
  const Fixture f;
  EXPECT_NEAR(mean(f.scene, f.slot).x, 3.5f, 1e-6f);
  EXPECT_EQ(mean(f.scene, Slot(Rgb(1, 2, 3))), Rgb(1, 2, 3));
}

TEST(Texture, MeshColoursInterpolate) {
  Scene scene;
  Mesh mesh = kit::rectangle(Mat4(1));
  mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  Surface at;
  at.shape = kit::add_mesh(scene, mesh);
  at.bary = {0.25f, 0.5f};
  scene.textures.emplace_back();
  scene.textures[0].kind = TextureKind::mesh_attribute;
  scene.textures[0].attribute = "vertex_color";
  Slot slot;
  slot.texture = 0;
  EXPECT_EQ(eval(scene, slot, at), Rgb(0.25f, 0.25f, 0.5f));
  EXPECT_EQ(mean(scene, slot), Rgb(0.5f));
}

}  // namespace
}  // namespace ajar
