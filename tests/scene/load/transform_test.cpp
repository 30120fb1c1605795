// <transform> in all its steps.
#include <chrono>
#include <filesystem>
#include <fstream>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

// Where the transform takes a point.
Vec3 moved(const std::string& steps, const Vec3& p) {
  const Scene s = load_inside("<shape type='disk'><transform name='toWorld'>" + steps + "</transform></shape>");
  return Vec3(s.shapes[0].to_world * Vec4(p, 1));
}
std::string error(const std::string& steps, const std::string& shape = "cube") {
  return error_of("<shape type='" + shape + "'><transform name='to_world'>" + steps + "</transform></shape>");
}

TEST(Transform, SingleSteps) {
  EXPECT_RGB(moved("<translate x='1' z='3'/>", {0, 0, 0}), 1, 0, 3, 1e-6);
  EXPECT_RGB(moved("<translate value='1, 2, 3'/>", {0, 0, 0}), 1, 2, 3, 1e-6);
  EXPECT_RGB(moved("<scale x='2'/>", {1, 1, 1}), 2, 1, 1, 1e-6);
  EXPECT_RGB(moved("<scale value='2'/>", {1, 1, 1}), 2, 2, 2, 1e-6);
  EXPECT_RGB(moved("<scale value='2 3 4'/>", {1, 1, 1}), 2, 3, 4, 1e-6);
  EXPECT_RGB(moved("<rotate z='1' angle='90'/>", {1, 0, 0}), 0, 1, 0, 1e-6);
  EXPECT_RGB(moved("<rotate x='0' y='2' angle='90'/>", {1, 0, 0}), 0, 0, -1, 1e-6);
  EXPECT_RGB(moved("<rotate value='0, 0, 1' angle='-90'/>", {1, 0, 0}), 0, -1, 0, 1e-6);
  EXPECT_RGB(moved("<matrix value='1 0 0 5  0 1 0 6  0 0 1 7  0 0 0 1'/>", {1, 2, 3}), 6, 8, 10, 1e-6);
  EXPECT_RGB(moved("<matrix value='0,1,0,1,0,0,0,0,1'/>", {1, 2, 3}), 2, 1, 3, 1e-6);
  EXPECT_RGB(moved("<matrix value='1 1e-007 0 0 0 1 0 0 0 0 1 0 0 0 0 1 '/>", {1, 2, 3}), 1, 2, 3, 1e-6);
}

// An empty number is left out, to Mitsuba 0.6.
TEST(Transform, EmptyNumbersAreLeftOutInVersion0) {
  const std::string steps = "<shape type='disk'><transform name='toWorld'><translate x='' y='2'/></transform></shape>";
  EXPECT_RGB(Vec3(load_inside(steps, {}, "0.6.0").shapes[0].to_world[3]), 0, 2, 0, 1e-6);
  EXPECT_SAYS(error_of(steps), "is not a number");
}

TEST(Transform, StepsFollowTheFile) {
  EXPECT_RGB(moved("<translate x='1'/><scale value='2'/>", {0, 0, 0}), 2, 0, 0, 1e-6);
  EXPECT_RGB(moved("<scale value='2'/><translate x='1'/>", {0, 0, 0}), 1, 0, 0, 1e-6);
  EXPECT_RGB(moved("<scale value='2'/><rotate z='1' angle='90'/><translate y='1'/>", {1, 0, 0}), 0, 3, 0, 1e-6);
}

TEST(Transform, LookatLooksAlongZ) {
  for (const char* tag : {"lookat", "lookAt"}) {
    const std::string step = std::string("<") + tag + " origin='1, 2, 3' target='1 2 13' up='0, 1, 0'/>";
    EXPECT_RGB(moved(step, {0, 0, 0}), 1, 2, 3, 1e-6);
    EXPECT_RGB(moved(step, {0, 0, 1}), 1, 2, 4, 1e-6);
    EXPECT_RGB(moved(step, {0, 1, 0}), 1, 3, 3, 1e-6);
    EXPECT_RGB(moved(step, {1, 0, 0}), 2, 2, 3, 1e-6);
  }
  EXPECT_RGB(moved("<lookat origin='0,0,0' target='0,5,0'/>", {0, 0, 1}), 0, 1, 0, 1e-6);  // up is found
  EXPECT_RGB(moved("<lookat origin='0,0,0' target='0,5,0' up=''/>", {0, 0, 1}), 0, 1, 0, 1e-6);
}

TEST(Transform, FlatShapesNeedNoDepth) {
  const Scene s =
      load_inside("<shape type='rectangle'><transform name='to_world'><scale x='2' y='3' z='0'/></transform></shape>");
  EXPECT_FLOAT_EQ(s.meshes[0].positions[0].x * s.meshes[0].positions[0].x, 4);
  EXPECT_EQ(error("<scale x='2' y='3' z='0'/>", "disk"), "");
}

TEST(Transform, WrongOnesAreErrors) {
  EXPECT_SAYS(error("<scale value='0'/>"), "singular");
  EXPECT_SAYS(error("<scale y='0'/>"), "singular");
  EXPECT_SAYS(error("<scale y='0'/>", "rectangle"), "singular");
  EXPECT_SAYS(error("<scale value='1e-45'/>"), "singular");
  EXPECT_SAYS(error("<matrix value='1 2 3'/>"), "16 (or 9) numbers");
  EXPECT_SAYS(error("<matrix/>"), "16 (or 9) numbers");
  EXPECT_SAYS(error("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1'/>"), "projective");
  EXPECT_SAYS(error("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0'/>"), "singular");
  EXPECT_SAYS(error("<translate x='nan'/>"), "\"nan\" is not a number");
  EXPECT_SAYS(error("<translate x='1e99'/>"), "beyond the range");
  EXPECT_SAYS(error("<scale value='1e30'/><scale value='1e30'/>"), "beyond the range");
  EXPECT_SAYS(error("<scale val='2'/>"), "<scale>: has neither value nor x, y, z");
  EXPECT_SAYS(error("<scale/>"), "has neither value nor x, y, z");
  EXPECT_SAYS(error("<translate dx='2'/>"), "has neither value nor x, y, z");
  EXPECT_SAYS(error("<scale value='2' x='1'/>"), "has both value and x, y, z");
  EXPECT_SAYS(error("<rotate angle='5'/>"), "needs an axis");
  EXPECT_SAYS(error("<rotate y='1'/>"), "needs angle=\"...\", in degrees");
  EXPECT_EQ(error("<rotate x='0' y='0' z='0' angle='0'/>"), "");
  EXPECT_SAYS(error("<lookat origin='nan,0,1' target='0,0,0'/>"), "origin=\"nan,0,1\" should be three numbers");
  EXPECT_SAYS(error("<lookat origin='1e300,0,0' target='0,0,0' up='0,1,0'/>"), "origin is beyond the range of numbers");
  EXPECT_SAYS(error("<lookat origin='0,0,0' target='0,0,0' up='0,1,0'/>"), "the same point; move one of them");
  EXPECT_SAYS(error("<lookat origin='0,0,0' target='0,2,0' up='0,1,0'/>"), "up points along");
  EXPECT_SAYS(error("<lookat target='0,2,0' up='0,1,0'/>"), "needs origin");
  EXPECT_SAYS(error("\n<turn x='1'/>"), "test.xml:3: <turn>: is unknown inside <transform>");
  EXPECT_SAYS(error_of("<shape type='cube'><float name='to_world' value='1'/></shape>"), "should be a <transform>");
}

// Without up, or with a zero one, Mitsuba's own choice: across the line of sight, another one in 0.x than later. By
// hand from the two definitions.
TEST(Transform, UsualUp) {
  const auto up = [](const std::string& origin, const std::string& more, const char* version) {
    const Scene s = load_scene_text(std::string("<scene version='") + version +
                                        "'><sensor type='perspective'><transform name='toWorld'><lookat origin='" +
                                        origin + "' target='0,0,0'" + more + "/></transform></sensor></scene>",
                                    "", "test.xml");
    return Vec3(s.camera.to_world[1]);
  };
  for (const char* more : {"", " up='0,0,0'"}) {
    EXPECT_RGB(up("0,0,20", more, "0.6.0"), 1, 0, 0, 1e-6);
    EXPECT_RGB(up("0,0,20", more, "3.0.0"), 1, 0, 0, 1e-6);
    EXPECT_RGB(up("0,0,-20", more, "3.0.0"), 1, 0, 0, 1e-6);
    EXPECT_RGB(up("-4,0,-3", more, "0.6.0"), 0, -1, 0, 1e-6);  // sees along (0.8, 0, 0.6); head first, as it is there
    EXPECT_RGB(up("-4,0,-3", more, "3.0.0"), 0.6, 0, -0.8, 1e-6);
    EXPECT_RGB(up("0,-4,3", more, "0.6.0"), 1, 0, 0, 1e-6);                         // along (0, 0.8, -0.6)
    EXPECT_RGB(up("-2,-1,2", more, "3.0.0"), 11 / 15.0, -2 / 15.0, 2 / 3.0, 1e-6);  // along (2, 1, -2) / 3
  }
  EXPECT_RGB(up("0,0,20", " up='0,1,0'", "3.0.0"), 0, 1, 0, 1e-6);
}

// Where an <animation> of these keys takes a point at a time.
Vec3 moved_at(std::optional<double> time, const std::string& keys, const Vec3& p) {
  LoadOptions options;
  options.time = time;
  const Scene s = load_inside("<shape type='disk'><animation name='toWorld'>" + keys + "</animation></shape>", options);
  return Vec3(s.shapes[0].to_world * Vec4(p, 1));
}

TEST(Animation, RestsBeforeAndAfterItsKeys) {
  const std::string keys =
      "<transform time='3'><translate x='5'/></transform><transform time='1'><translate x='1'/></transform>";
  EXPECT_RGB(moved_at({}, keys, {0, 0, 0}), 1, 0, 0, 1e-6);
  EXPECT_RGB(moved_at(-1, keys, {0, 0, 0}), 1, 0, 0, 1e-6);
  EXPECT_RGB(moved_at(1, keys, {0, 0, 0}), 1, 0, 0, 1e-6);
  EXPECT_RGB(moved_at(1.5, keys, {0, 0, 0}), 2, 0, 0, 1e-6);
  EXPECT_RGB(moved_at(3, keys, {0, 0, 0}), 5, 0, 0, 1e-6);
  EXPECT_RGB(moved_at(9, keys, {0, 0, 0}), 5, 0, 0, 1e-6);
}

TEST(Animation, OfAnotherNameIsNotUsed) {
  const Scene s =
      load_inside("<shape type='sphere'><animation name='animation'><transform time='0'/></animation></shape>");
  EXPECT_TRUE(says(s.notes, "the parameter \"animation\" is not used"));
}

// As in scenes of a time when Mitsuba 3 called it so.
TEST(Animation, OfAnInstanceMayBeCalledAnimation) {
  const Scene s = load_inside(
      "<shape type='shapegroup' id='g'><shape type='sphere'/></shape>"
      "<shape type='instance'><ref id='g'/><animation name='animation'><transform time='1'/>"
      "<transform time='0'><translate x='3'/></transform></animation></shape>");
  EXPECT_RGB(Vec3(s.instances[0].to_world[3]), 3, 0, 0, 1e-6);
  EXPECT_FALSE(says(s.notes, "not used"));
}

// As of Mitsuba 3.9; hints tell of those alone that something moves by.
TEST(Animation, MayBeSharedById) {
  const std::string shared =
      "<animation id='a'><transform time='0'/><transform time='1'><translate x='3'/></transform></animation>";
  const std::string shape = "<shape type='disk'><ref name='to_world' id='a'/></shape>";
  LoadOptions late;
  late.time = 0.5;
  const Scene s = load_inside(shape + shared + shape, late);
  EXPECT_EQ(s.shapes.size(), 2u);
  for (const Shape& moved : s.shapes) EXPECT_FLOAT_EQ(moved.to_world[3].x, 1.5f);
  EXPECT_EQ(s.hints.last_time, 1);
  EXPECT_FALSE(says(s.notes, "animation"));
  EXPECT_LT(load_inside(shared + "<shape type='disk'/>").hints.last_time, 0);
  EXPECT_SAYS(error_of(shared + "<shape type='disk'><transform name='to_world'/><ref name='to_world' id='a'/></shape>"),
              "stands beside a <transform>");
  EXPECT_SAYS(error_of("<bsdf type='diffuse' id='m'/><shape type='disk'><ref name='to_world' id='m'/></shape>"),
              "should be a <transform>");
  EXPECT_SAYS(error_of("<animation><transform time='0'/></animation>"), "<animation>: unknown element");
}

TEST(Animation, TurnsRatherThanSqueezes) {
  const std::string keys =
      "<transform time='0'><scale value='2'/></transform>"
      "<transform time='1'><scale value='4'/><rotate z='1' angle='120'/><translate y='1'/></transform>";
  const double half = std::sqrt(0.75);
  EXPECT_RGB(moved_at(0.5, keys, {1, 0, 0}), 1.5, 3 * half + 0.5, 0, 1e-5);
  const std::string mirrored =
      "<transform time='0'><scale x='-1'/></transform>"
      "<transform time='1'><scale x='-1'/><rotate z='1' angle='90'/></transform>";
  EXPECT_RGB(moved_at(0.5, mirrored, {1, 0, 0}), -std::sqrt(0.5), -std::sqrt(0.5), 0, 1e-5);
}

// As Mitsuba's: a picture is taken when the shutter opens.
TEST(Animation, IsReadWhenTheShutterOpens) {
  const std::string moves =
      "<shape type='disk'><animation name='to_world'><transform time='-1'/><transform time='3'><translate x='4'/>"
      "</transform></animation></shape>";
  EXPECT_FLOAT_EQ(load_inside(moves).shapes[0].to_world[3].x, 1);  // at 0
  const auto opened = [&](const char* time) {
    return load_scene_text("<scene version='3.0.0'>" + moves +
                               "<sensor type='perspective'><float name='shutterOpen' value='" + time +
                               "'/></sensor></scene>",
                           "", "test.xml")
        .shapes[0]
        .to_world[3]
        .x;
  };
  EXPECT_FLOAT_EQ(opened("2"), 3);
  EXPECT_FLOAT_EQ(opened("7"), 4);
}

TEST(Animation, TellsWhenItsKeysAre) {
  const Scene still = load_inside("<shape type='cube'/>");
  EXPECT_GT(still.hints.first_time, still.hints.last_time);
  const Scene s = load_inside(
      "<shape type='cube'><animation name='to_world'><transform time='-1'/>"
      "<transform time='2.5'/></animation></shape>");
  EXPECT_EQ(s.hints.first_time, -1);
  EXPECT_EQ(s.hints.last_time, 2.5);
}

TEST(Animation, WrongOnesAreErrors) {
  const auto wrong = [](const std::string& keys, const std::string& beside = "") {
    return error_of("<shape type='cube'>" + beside + "<animation name='to_world'>" + keys + "</animation></shape>");
  };
  EXPECT_SAYS(wrong(""), "needs <transform time=");
  EXPECT_SAYS(wrong("<transform/>"), "needs time=");
  EXPECT_SAYS(wrong("<transform time='soon'/>"), "\"soon\" is not a number");
  EXPECT_SAYS(wrong("<float name='x' value='1'/>"), "is unknown inside <animation>");
  EXPECT_SAYS(wrong("<transform time='1'/><transform time='1'/>"), "the time of another");
  EXPECT_SAYS(wrong("<transform time='1'/>", "<transform name='to_world'/>"), "stands beside a <transform>");
}

// What a first load read from files a second one need not read; of one that changed it is told, whether read or not.
TEST(LoadCache, ReadsWhatStaysOnce) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "load_cache";
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "triangle.obj").string();
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  LoadCache cache;
  LoadOptions options;
  options.cache = &cache;
  const auto load_at = [&](double time, const char* to) {
    options.time = time;
    return load_inside("<shape type='obj'><string name='filename' value='" + file +
                           "'/><animation name='to_world'><transform time='0'/><transform time='1'><translate x='" +
                           to + "'/></transform></animation></shape>",
                       options);
  };
  const auto refused = [&](double time) {
    try {
      load_at(time, "1");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Scene first = load_at(0, "1");
  const auto written = std::filesystem::last_write_time(file);
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";  // whoever reads it throws
  std::filesystem::last_write_time(file, written);
  const Scene again = load_at(0, "1");  // by its size and time it is the same: it is not looked into
  EXPECT_EQ(again.meshes[0].positions, first.meshes[0].positions);
  EXPECT_EQ(again.meshes[0].triangles, first.meshes[0].triangles);
  std::filesystem::last_write_time(file, written + std::chrono::seconds(1));
  const std::string told = file + ": has changed since the animation began; give the command again";
  EXPECT_EQ(refused(0), told);
  EXPECT_EQ(refused(1), told);
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";  // as it was, if later
  EXPECT_EQ(refused(1), "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace ajar
