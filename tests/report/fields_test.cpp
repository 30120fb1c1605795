// What is told and shown of learned fields, on fields made by hand.
#include "ajar/report/fields.h"

#include <gtest/gtest.h>

#include <set>

#include "ajar/field/learn.h"
#include "ajar/scene/build.h"
#include "kit/stage.h"

namespace ajar {
namespace {

constexpr int width = 64, height = 64;

// The open room with cells on its floor and its back wall alone; light on the floor comes from the right.
struct FieldsShown : testing::Test {
  Scene scene;
  Fields fields;

  void SetUp() override {
    kit::add_open_room(scene);
    Camera& c = scene.camera;
    c.width = c.crop_width = width, c.height = c.crop_height = height;
    set_perspective(c, 40, look_at({0, 0, 4}, Vec3(0)));
    finish(scene);
    fields = start_fields(scene, width * height);
    for (int i = 0; i < 400; ++i) {
      const float u = float(i % 20) / 10 - 0.95f, v = float(i / 20) / 10 - 0.95f;
      add({u, -1, v}, {0, 1, 0}, 10, true);
      add({u, v, -1}, {0, 0, 1}, 0.1f, false);
    }
  }

  void add(const Vec3& p, const Vec3& n, float total, bool from_right) {
    const Place at = find(fields.table, p, n);
    if (at.cell != none) return;
    insert(fields.table, at.missing, uint32_t(fields.cells.size()));
    fields.cells.push_back({at.missing, make_frame(n), middle_of(fields.table, at.missing), 1});
    const Frame& frame = fields.cells.back().frame;
    for (Field* f : {&fields.q, &fields.w}) {
      f->cells.push_back({uint32_t(f->nodes.size()), 0, total, 0.5f, 1});
      StrataNode node;
      for (int i = 0; i < 16; ++i) {
        const Vec3 w = frame.to_world(from_square((Vec2(float(i % 4), float(i / 4)) + 0.5f) / 4.0f));
        node.before[i] = uint16_t(4096 * i);
        f->mean.push_back(from_right && w.x < 0 ? 0.001f : 1);
        f->weight.push_back(1);
      }
      f->nodes.push_back(node);
    }
  }

  Rgb pixel(const Picture& p, int x, int y) const {
    const float* at = &p.pixels[3 * size_t(y * width + x)];
    return {at[0], at[1], at[2]};
  }
};

TEST_F(FieldsShown, CellsHaveColours) {
  const Accel accel(scene);
  const Picture picture = picture_cells(scene, accel, fields);
  ASSERT_EQ(picture.pixels.size(), size_t(3 * width * height));
  std::set<uint32_t> cells;
  std::set<std::tuple<float, float, float>> colours;
  for (int y = 28; y < 36; ++y)
    for (int x = 20; x < 44; ++x) {
      const CameraRay ray = generate(scene.camera, Vec2(float(x) + 0.5f, float(y) + 0.5f), Vec2(0));
      cells.insert(find(fields.table, ray.o + ray.d * (5 / -ray.d.z), {0, 0, 1}).cell);
      const Rgb c = glm::normalize(pixel(picture, x, y));
      colours.insert({std::round(c.x * 50), std::round(c.y * 50), std::round(c.z * 50)});
    }
  EXPECT_GT(cells.size(), 3u);
  EXPECT_GE(colours.size(), cells.size()) << "cells can be told apart";
  EXPECT_LE(colours.size(), 2 * cells.size()) << "a cell has one colour, but for shading";
  const Rgb left = pixel(picture, 3, 32);  // wall without cells
  EXPECT_EQ(left.x, left.y);
  EXPECT_EQ(left.y, left.z);
  EXPECT_EQ(pixel(picture, 32, 0), Rgb(0)) << "nothing is hit";
}

TEST_F(FieldsShown, TotalsRunFromDarkToBright) {
  const Accel accel(scene);
  for (const Side side : {Side::camera, Side::light}) {
    const FalseColour shown = picture_totals(scene, accel, fields, side);
    EXPECT_FLOAT_EQ(shown.low, 0.1f);
    EXPECT_FLOAT_EQ(shown.high, 10.0f);
    EXPECT_EQ(pixel(shown.picture, 32, 32), Rgb(0)) << "back wall";
    EXPECT_EQ(pixel(shown.picture, 32, 56), Rgb(1)) << "floor";
    const Rgb left = pixel(shown.picture, 3, 32);
    EXPECT_EQ(left.x, left.z);
    EXPECT_GT(left.x, 0);
  }
  // Only the side asked for is shown.
  for (FieldCell& c : fields.w.cells) c.total = 3;
  const FalseColour flat = picture_totals(scene, accel, fields, Side::light);
  EXPECT_EQ(flat.low, flat.high);
  EXPECT_EQ(pixel(flat.picture, 32, 32), Rgb(1));
  for (FieldCell& c : fields.w.cells) c.total = 0;
  EXPECT_EQ(picture_totals(scene, accel, fields, Side::light).high, 0);
}

TEST_F(FieldsShown, DisksShowWhereLightComesFrom) {
  const Accel accel(scene);
  for (FieldCell& c : fields.q.cells)
    if (c.total < 1) c.mix = 0;  // no disks on the back wall
  const Picture picture = picture_strata(scene, accel, fields, Side::camera);
  int white = 0, black = 0;
  double x_white = 0, x_black = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c = pixel(picture, x, y);
      if (c == Rgb(1)) ++white, x_white += x;
      if (c == Rgb(0) && y > 44) ++black, x_black += x;
    }
  ASSERT_GT(white, 20);
  ASSERT_GT(black, 20);
  const double right_of_black = x_white / white - x_black / black;
  EXPECT_GT(right_of_black, 2) << "the right halves are lit";
  EXPECT_NE(picture_strata(scene, accel, fields, Side::light).pixels, picture.pixels) << "W has disks on the back wall";
}

TEST_F(FieldsShown, LinesCount) {
  fields.generation = 3;
  const std::string text = describe({fields, "the scene", 12});
  const auto has = [&](const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  };
  has("scene: the scene\n");
  has("learned 3 times; whoever goes on from them begins with pass 12; " + std::to_string(bytes(fields)) + " bytes\n");
  has(std::to_string(fields.cells.size()) + " cells; level 0: " + std::to_string(fields.cells.size()));
  has("Q: " + std::to_string(fields.q.nodes.size()) + " nodes of 16 strata; level 0: ");
  has("0.4 to 0.6: " + std::to_string(fields.cells.size()));
  has("irradiance [W/m^2]: 0.1 to 10, median");
  has("none in 0 cells");
  const std::string empty = describe({start_fields(scene, 1), "", 0});
  EXPECT_NE(empty.find("0 cells; none"), std::string::npos) << empty;
  EXPECT_NE(empty.find("none anywhere"), std::string::npos) << empty;
}

}  // namespace
}  // namespace ajar
