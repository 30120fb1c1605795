// Sensor, film, filter, sampler, integrator.
#include "ajar/scene/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

Scene read(const std::string& inside, const std::string& type = "perspective", const LoadOptions& options = {}) {
  return load_scene_text("<scene version='3.0.0'><sensor type='" + type + "'>" + inside + "</sensor></scene>", assets(),
                         "test.xml", options);
}
std::string error(const std::string& inside, const std::string& type = "perspective") {
  try {
    read(inside, type);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}
std::string film(int width, int height, const std::string& inside = "") {
  return "<film type='hdrfilm'><integer name='width' value='" + std::to_string(width) +
         "'/><integer name='height' value='" + std::to_string(height) + "'/>" + inside + "</film>";
}
std::string fov(double degrees, const std::string& axis) {
  return "<float name='fov' value='" + std::to_string(degrees) + "'/><string name='fovAxis' value='" + axis + "'/>";
}
double fov_x(const Scene& s) { return 2 * std::atan(double(s.camera.plane.x)) * 180 / std::numbers::pi; }

TEST(Sensors, FieldOfView) {
  EXPECT_NEAR(fov_x(read("<float name='fov' value='60'/>")), 60, 1e-4);
  EXPECT_NEAR(fov_x(read(film(400, 200) + fov(60, "x"))), 60, 1e-4);
  const double from_y = 2 * std::atan(2 * std::tan(std::numbers::pi / 6)) * 180 / std::numbers::pi;
  EXPECT_NEAR(fov_x(read(film(400, 200) + fov(60, "y"))), from_y, 1e-4);
  EXPECT_NEAR(fov_x(read(film(400, 200) + fov(60, "smaller"))), from_y, 1e-4);
  EXPECT_NEAR(fov_x(read(film(400, 200) + fov(60, "larger"))), 60, 1e-4);
  EXPECT_NEAR(fov_x(read(film(200, 400) + fov(60, "smaller"))), 60, 1e-4);
  const Camera c = read(film(400, 300) + fov(60, "diagonal")).camera;
  EXPECT_NEAR(std::hypot(c.plane.x, c.plane.y), std::tan(std::numbers::pi / 6), 1e-6);
  EXPECT_NEAR(c.plane.x / c.plane.y, 4.0 / 3, 1e-6);
}

// Another size shows what the file would show if it named that size.
TEST(Sensors, AnotherSizeKeepsTheAxis) {
  const std::string stretched = "<transform name='to_world'><scale x='1' y='2' z='1'/></transform>";
  for (const char* axis : {"x", "y", "smaller", "larger", "diagonal"})
    for (const auto& [w, h] : {std::pair(300, 300), {500, 200}, {100, 400}})
      for (const std::string& inside : {fov(50, axis), fov(50, axis) + stretched, std::string()}) {
        Camera c = read(film(400, 300) + inside).camera;
        set_size(c, w, h);
        const Camera named = read(film(w, h) + inside).camera;
        EXPECT_NEAR(c.plane.x, named.plane.x, 1e-5f * named.plane.x) << axis << " " << w << "x" << h;
        EXPECT_NEAR(c.plane.y, named.plane.y, 1e-5f * named.plane.y) << axis << " " << w << "x" << h;
        EXPECT_EQ(c.width, w);
        EXPECT_EQ(c.crop_height, h);
      }
  Camera flat = read(film(400, 300), "orthographic").camera;
  set_size(flat, 200, 300);
  EXPECT_RGB(Vec3(flat.plane, 0), 1, 1.5, 0, 1e-6);
}

TEST(Sensors, FocalLength) {  // a 35 mm film: 36 x 24, diagonal 43.27 mm
  EXPECT_NEAR(fov_x(read(film(360, 240) + "<string name='focalLength' value='50mm'/>")), 39.5978, 1e-3);
  EXPECT_NEAR(fov_x(read(film(360, 240))), 39.5978, 1e-3);
  EXPECT_NEAR(fov_x(read(film(360, 240) + "<string name='focal_length' value='18 mm'/>")), 90, 1e-3);
  EXPECT_NEAR(fov_x(read(film(360, 240) + "<float name='focal_length' value='18'/>")), 90, 1e-3);
  EXPECT_SAYS(error("<string name='focal_length' value='wide'/>"), "focal_length should be like \"50mm\"");
}

// Camera space: x to the left, y up, z ahead.
TEST(Sensors, LooksWhereToWorldSays) {
  const Scene s = read(film(100, 100) + fov(90, "x") +
                       "<transform name='toWorld'><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>");
  CameraRay ray = generate(s.camera, {50, 50}, {0.5f, 0.5f});
  EXPECT_RGB(ray.o, 0, 0, 5, 1e-6);
  EXPECT_RGB(ray.d, 0, 0, -1, 1e-6);
  ray = generate(s.camera, {100, 50}, {0.5f, 0.5f});  // right edge
  EXPECT_RGB(ray.d, std::sqrt(0.5), 0, -std::sqrt(0.5), 1e-6);
  ray = generate(s.camera, {50, 0}, {0.5f, 0.5f});  // upper edge
  EXPECT_RGB(ray.d, 0, std::sqrt(0.5), -std::sqrt(0.5), 1e-6);
  const Scene mirrored =
      read(film(100, 100) + fov(90, "x") +
           "<transform name='toWorld'><scale x='-1'/><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>");
  EXPECT_RGB(generate(mirrored.camera, {100, 50}, {0.5f, 0.5f}).d, -std::sqrt(0.5), 0, -std::sqrt(0.5), 1e-6);
}

TEST(Sensors, ScaleIsFoldedIntoTheView) {
  const Camera c =
      read(film(100, 100) + fov(90, "x") + "<transform name='to_world'><scale x='6' y='2' z='2'/></transform>").camera;
  EXPECT_NEAR(c.plane.x, 3, 1e-5);
  EXPECT_NEAR(c.plane.y, 1, 1e-5);
  EXPECT_NEAR(glm::length(Vec3(c.to_world[0])), 1, 1e-6);
  EXPECT_SAYS(error("<transform name='to_world'><scale value='0'/></transform>"), "singular");
  EXPECT_SAYS(error("<transform name='to_world'><matrix value='1 1 0 0 0 1 0 0 0 0 1 0 0 0 0 1'/></transform>"),
              "sheared");
}

TEST(Sensors, Orthographic) {
  const Camera c = read(film(200, 100) +
                            "<transform name='to_world'><scale x='10' y='10'/><translate z='-5'/></transform><float "
                            "name='near_clip' value='0'/>",
                        "orthographic")
                       .camera;
  EXPECT_EQ(c.kind, CameraKind::orthographic);
  EXPECT_NEAR(c.plane.x, 10, 1e-5);
  EXPECT_NEAR(c.plane.y, 5, 1e-5);
  const CameraRay ray = generate(c, {0, 0}, {0.5f, 0.5f});
  EXPECT_RGB(ray.o, 10, 5, -5, 1e-5);
  EXPECT_RGB(ray.d, 0, 0, 1, 1e-6);
}

TEST(Sensors, ThinLens) {
  const Camera c =
      read("<float name='apertureRadius' value='0.1'/><float name='focus_distance' value='4'/>", "thinlens").camera;
  EXPECT_EQ(c.kind, CameraKind::thinlens);
  EXPECT_FLOAT_EQ(c.aperture, 0.1f);
  EXPECT_FLOAT_EQ(c.focus, 4);
  EXPECT_SAYS(error("", "thinlens"), "needs an aperture_radius");
  EXPECT_SAYS(error("<float name='aperture_radius' value='-1'/>", "thinlens"), "needs an aperture_radius, 0 to 1e+18");
  EXPECT_SAYS(error("<float name='aperture_radius' value='1e20'/><float name='focus_distance' value='1'/>", "thinlens"),
              "needs an aperture_radius, 0 to 1e+18");
  EXPECT_EQ(error("<float name='aperture_radius' value='0'/><string name='far_clip' value='inf'/>", "thinlens"), "");
  const std::string wide = "<float name='aperture_radius' value='0.1'/>";
  EXPECT_FLOAT_EQ(read(wide, "thinlens").camera.focus, 10000);
  EXPECT_FLOAT_EQ(read(wide + "<float name='farClip' value='50'/>", "thinlens").camera.focus, 50);
  const Scene pinhole = read("<float name='aperture_radius' value='0'/>", "thinlens");
  EXPECT_EQ(pinhole.camera.kind, CameraKind::perspective);
  EXPECT_TRUE(says(pinhole.notes, "is a pinhole"));
}

TEST(Sensors, ClipAndPrincipalPoint) {
  const Camera c = read(
                       "<float name='nearClip' value='0.5'/><float name='far_clip' value='20'/>"
                       "<float name='principalPointOffsetX' value='0.25'/>")
                       .camera;
  EXPECT_FLOAT_EQ(c.near_clip, 0.5f);
  EXPECT_FLOAT_EQ(c.far_clip, 20);
  EXPECT_FLOAT_EQ(c.principal.x, 0.25f);
  EXPECT_SAYS(error("<float name='near_clip' value='5'/><float name='far_clip' value='2'/>"), "near < far");
  EXPECT_SAYS(error("<float name='fov' value='180'/>"), "fov should be");
  EXPECT_SAYS(error("<float name='fov' value='0'/>"), "fov should be");
}

// As Mitsuba 2 reads it.
TEST(Sensors, SeeAsFarAsThereIs) {
  for (const std::string word : {"inf", "Infinity"}) {
    const std::string far = "<float name='farClip' value='" + word + "'/>", wide =
                                                                                "<float name='apertureRadius' "
                                                                                "value='.1'/>";
    const Camera c = read(far).camera;
    EXPECT_EQ(c.far_clip, infinity);
    CameraConnection seen;
    EXPECT_TRUE(connect(c, Vec3(0, 0, 1e9f), {0.5f, 0.5f}, 0, seen));
    EXPECT_EQ(generate(c, {1, 1}, {0.5f, 0.5f}).t_max, infinity);
    EXPECT_EQ(read(far + wide + "<float name='focusDistance' value='2'/>", "thinlens").camera.focus, 2);
    EXPECT_SAYS(error(far + wide, "thinlens"), "needs a focus_distance, as its far_clip is infinite");
  }
  EXPECT_SAYS(error("<float name='near_clip' value='inf'/>"), "is not a number");
  EXPECT_SAYS(error("<float name='far_clip' value='-inf'/>"), "is not a number");
}

TEST(Sensors, InsideShapesAreToldAsOthers) {
  const auto inside = [](const std::string& type) {
    return "<shape type='rectangle'><sensor type='" + type + "'/></shape>";
  };
  EXPECT_EQ(error_of(inside("irradiancemeter")),
            "test.xml:2: <sensor type=\"irradiancemeter\">: unknown sensor; supported: perspective, thinlens, "
            "orthographic; with --lenient: left out");
  EXPECT_SAYS(error_of(inside("perspective")), "a sensor inside a shape is not supported; put it beside the shape");
  const Scene s = load_inside(inside("irradiancemeter"), lenient());
  EXPECT_EQ(s.shapes.size(), 1u);
  EXPECT_TRUE(says(s.notes, "unknown sensor; supported: perspective, thinlens, orthographic: left out"));
}

TEST(Films, SizeAndCrop) {
  Camera c = read("").camera;
  EXPECT_EQ(c.width, 768);
  EXPECT_EQ(c.height, 576);
  EXPECT_EQ(c.crop_width, 768);
  c = read(film(400, 300,
                "<integer name='cropOffsetX' value='100'/><integer name='crop_offset_y' value='50'/>"
                "<integer name='crop_width' value='200'/><integer name='cropHeight' value='100'/>"))
          .camera;
  EXPECT_EQ(c.crop_x, 100);
  EXPECT_EQ(c.crop_y, 50);
  EXPECT_EQ(c.crop_width, 200);
  EXPECT_EQ(c.crop_height, 100);
  EXPECT_EQ(read("<film type='ldrfilm'/>").camera.height, 576);
  c = read("<film type='mfilm'/>").camera;
  EXPECT_EQ(c.width, 1);
  EXPECT_EQ(c.height, 1);
  EXPECT_TRUE(says(read("<film type='streakhdrfilm'/>").notes, "unknown film"));
  EXPECT_SAYS(error(film(0, 10)), "from 1 to 65536");
  EXPECT_SAYS(error(film(100000, 10)), "from 1 to 65536");
  EXPECT_SAYS(error("<film type='hdrfilm'><integer name='width' value='12.5'/></film>"), "whole number");
  EXPECT_SAYS(error(film(10, 10, "<integer name='crop_width' value='11'/>")), "from 1 to 10");
}

TEST(Films, Filters) {
  const auto filter = [](const std::string& type, const std::string& inside = "") {
    return read(film(10, 10, "<rfilter type='" + type + "'>" + inside + "</rfilter>")).filter;
  };
  EXPECT_EQ(read("").filter.kind, FilterKind::gaussian);
  EXPECT_EQ(filter("box").kind, FilterKind::box);
  EXPECT_EQ(filter("tent").kind, FilterKind::tent);
  EXPECT_EQ(filter("mitchell").kind, FilterKind::mitchell);
  EXPECT_EQ(filter("catmullrom").kind, FilterKind::catmullrom);
  EXPECT_EQ(filter("lanczos", "<integer name='lobes' value='2'/>").kind, FilterKind::lanczos);
  EXPECT_EQ(filter("gaussian", "<float name='stddev' value='0.25'/>").a, 0.25f);
  EXPECT_EQ(filter("tent", "<float name='radius' value='1.5'/>").radius, 1.5f);
  const Filter zeros = filter("mitchell", "<float name='B' value='0'/><float name='C' value='0'/>");
  EXPECT_EQ(zeros.a, 0);
  EXPECT_EQ(zeros.b, 0);
  EXPECT_EQ(filter("mitchell").a, 1.0f / 3);
  EXPECT_EQ(filter("mitchell", "<float name='A' value='2'/>").b, 1.0f / 3);  // no parameter of Mitsuba's code
  EXPECT_SAYS(error(film(10, 10, "<rfilter type='sharp'/>")), "unknown filter; supported: box, tent");
  EXPECT_SAYS(error(film(10, 10, "<rfilter type='gaussian'><float name='stddev' value='100'/></rfilter>")),
              "stddev should be");
}

TEST(Sensors, FilmAndSamplerByReference) {
  const Scene s = load_scene_text(
      "<scene><film type='hdrfilm' id='f'><integer name='width' value='5'/></film><sampler type='independent' id='s'>"
      "<integer name='sampleCount' value='99999999999'/></sampler><sensor type='perspective'><ref id='f'/><ref "
      "id='s'/></sensor></scene>",
      "", "test.xml");
  EXPECT_EQ(s.camera.width, 5);
  EXPECT_GT(s.hints.spp, 1000000);  // as good as endless
}

TEST(Sensors, FirstOfSeveral) {
  const Scene s = load_inside("<sensor type='orthographic'/>");
  EXPECT_EQ(s.camera.kind, CameraKind::perspective);
  EXPECT_TRUE(says(s.notes, "several sensors: the first one is used"));
  const Scene old = load_inside("<sensor type='orthographic'/>", {}, "0.5.0");
  EXPECT_EQ(old.camera.kind, CameraKind::orthographic);
  EXPECT_TRUE(says(old.notes, "several sensors: the last one is used"));
  EXPECT_SAYS(error("", "irradiancemeter"), "unknown sensor; supported: perspective, thinlens, orthographic");
}

TEST(Sensors, BatchesAreRefused) {
  const std::string two =
      film(20, 10) + "<sensor type='orthographic'>" + film(30, 20) + "</sensor>" + "<sensor type='perspective'/>";
  EXPECT_EQ(
      error(two, "batch"),
      "test.xml:1: <sensor type=\"batch\">: several sensors on one film are not supported: put one of those inside it "
      "in its place, with a film of its own, and render the others by themselves; with --lenient: the first of them "
      "alone");
  const Scene first = read(two, "batch", lenient());
  EXPECT_EQ(first.camera.kind, CameraKind::orthographic);
  EXPECT_EQ(first.camera.width, 30);
  EXPECT_TRUE(says(first.notes, "the first of them alone"));
  EXPECT_THROW(read("", "batch", lenient()), Error);
  const auto of_itself = [] {
    load_scene_text("<scene version='3.0.0'><sensor type='batch' id='b'><ref id='b'/></sensor></scene>", "", "test.xml",
                    lenient());
  };
  EXPECT_THROW(of_itself(), Error);
}

// From before the scene, along z, so that its larger side just fits into 45 degrees.
TEST(Sensors, WithoutOneAllIsSeen) {
  const auto load = [](const std::string& inside) {
    return load_scene_text("<scene version='3.0.0'>" + inside + "</scene>", "", "test.xml");
  };
  const Scene s =
      load("<shape type='cube'><transform name='to_world'><scale x='3'/><translate x='1' z='5'/></transform></shape>");
  EXPECT_RGB(Vec3(s.camera.to_world[3]), 1, 0, 4 - 3 / std::tan(std::numbers::pi / 8), 1e-5);
  EXPECT_RGB(Vec3(s.camera.to_world[2]), 0, 0, 1, 0);
  EXPECT_NEAR(s.camera.plane.x, std::tan(std::numbers::pi / 8), 1e-6);
  EXPECT_TRUE(says(s.notes, "no camera: all of it is seen"));
  EXPECT_THROW(load("<emitter type='constant'/>"), Error);
}

// Misspelt names are told, as they are spelt; those of Mitsuba that change nothing here are not.
TEST(Sensors, UnknownParametersAreNoted) {
  const auto number = [](const char* name) { return std::string("<float name='") + name + "' value='2'/>"; };
  Scene s = read(film(10, 10, number("gammma") + number("gamma") + "<boolean name='attachLog' value='true'/>") +
                 "<sampler type='independent'>" + number("sampleCont") + number("seed") + "</sampler>");
  ASSERT_EQ(s.notes.size(), 4u);  // two of them: no shape, no light
  EXPECT_TRUE(says(s.notes, "<film type=\"hdrfilm\">: the parameter \"gammma\" is not used"));
  EXPECT_TRUE(says(s.notes, "<sampler type=\"independent\">: the parameter \"sampleCont\" is not used"));
  s = load_inside("<integrator type='path'>" + number("maxDepht") + number("rrDepth") + "</integrator>");
  ASSERT_EQ(s.notes.size(), 3u);
  EXPECT_TRUE(says(s.notes, "\"maxDepht\" is not used"));
  // of each kind of element that has it
  s = load_inside(
      "<shape type='sphere'><float name='scale' value='2'/><emitter type='area'><float name='scale' value='2'/>"
      "</emitter></shape>");
  EXPECT_TRUE(says(s.notes, "<shape type=\"sphere\">: the parameter \"scale\" is not used"));
  EXPECT_TRUE(says(s.notes, "<emitter type=\"area\">: the parameter \"scale\" is not used"));
  EXPECT_EQ(load_inside("<integrator type='theirs'>" + number("own") + "</integrator>").notes.size(), 3u);
}

TEST(Sensors, UnknownWordsAreNotesWhereLenient) {
  EXPECT_SAYS(error("<string name='fovAxis' value='up'/>"), "\"up\" is unknown here; known are x, y");
  const Scene s = read("<float name='fov' value='60'/><string name='fovAxis' value='up'/>", "perspective", lenient());
  EXPECT_NEAR(fov_x(s), 60, 1e-4);
  EXPECT_TRUE(says(s.notes, "<string name=\"fovAxis\">: \"up\" is unknown here"));
  EXPECT_TRUE(says(s.notes, "read as x"));
}

TEST(Integrators, AreHints) {
  const auto hints = [](const std::string& text) { return load_inside(text).hints; };
  Hints h = hints("<integrator type='path'><integer name='maxDepth' value='7'/></integrator>");
  EXPECT_EQ(h.integrator, "path");
  EXPECT_EQ(h.max_depth, 7);
  EXPECT_EQ(hints("").max_depth, -1);
  EXPECT_EQ(hints("<integrator type='volpath'/>").integrator, "path");
  EXPECT_EQ(hints("<integrator type='ptracer'/>").integrator, "light");
  h = hints("<integrator type='direct'/>");
  EXPECT_EQ(h.integrator, "path");
  EXPECT_EQ(h.max_depth, 2);
  EXPECT_EQ(hints("<integrator type='direct_projective'/>").max_depth, 2);
  for (const char* type : {"prb", "prb_basic", "prb_projective", "prb_reparam"}) {
    h = hints(fmt::format("<integrator type='{}'/>", type));
    EXPECT_EQ(h.integrator, "path") << type;
    EXPECT_EQ(h.max_depth, 6) << type;
  }
  EXPECT_EQ(hints("<integrator type='prbvolpath'/>").integrator, "path");
  EXPECT_EQ(hints("<integrator type='prbvolpath'/>").max_depth, hints("<integrator type='path'/>").max_depth);
  EXPECT_EQ(hints("<integrator type='prb'><integer name='max_depth' value='3'/></integrator>").max_depth, 3);
  EXPECT_EQ(hints("<integrator type='prb'><integer name='max_depth' value='-1'/></integrator>").max_depth, -1);
  h = hints(
      "<integrator type='aov'><string name='aovs' value='n:sh_normal'/><integrator type='moment'><integrator "
      "type='bdpt'>"
      "<integer name='max_depth' value='5'/></integrator></integrator></integrator>");
  EXPECT_EQ(h.integrator, "bdpt");
  EXPECT_EQ(h.max_depth, 5);
  EXPECT_EQ(hints("<integrator type='path'><integer name='max_depth' value='99999999999'/></integrator>").max_depth,
            1 << 30);
  const Scene s = load_inside("<integrator type='manifold_path'><integer name='max_depth' value='-1'/></integrator>");
  EXPECT_TRUE(says(s.notes, "Ajar has no integrator of this name"));
  EXPECT_EQ(s.hints.integrator, "");
}

// 0.6 leaves out what is emitted, later versions what emits.
TEST(Integrators, MayHideLights) {
  const auto lamps = [](const std::string& text, const char* version = "3.0.0") {
    const Scene scene = load_inside(text, {}, version);
    EXPECT_EQ(scene.notes, load_inside("<integrator type='path'/>", {}, version).notes);
    return scene.camera.lamps;
  };
  const std::string hides = "<integrator type='path'><boolean name='hide_emitters' value='true'/></integrator>",
                    old = "<integrator type='path'><boolean name='hideEmitters' value='true'/></integrator>";
  EXPECT_EQ(lamps("<integrator type='path'/>"), Lamps::seen);
  EXPECT_EQ(lamps("<integrator type='path'><boolean name='hide_emitters' value='false'/></integrator>"), Lamps::seen);
  EXPECT_EQ(lamps(hides), Lamps::gone);
  EXPECT_EQ(lamps(old, "0.6.0"), Lamps::dark);
  EXPECT_EQ(lamps("<integrator type='aov'>" + hides + "</integrator>"), Lamps::gone);
}

TEST(Integrators, NumbersThatAskForNothingAreErrors) {
  const auto depth = [](const std::string& value) {
    return error_of("<integrator type='path'><integer name='maxDepth' value='" + value + "'/></integrator>");
  };
  EXPECT_EQ(
      depth("0"),
      "test.xml:2: <integer name=\"maxDepth\">: 0 shows nothing; it should be 1 (lights alone) or more, or -1 for "
      "no limit; with --lenient: no limit");
  EXPECT_EQ(load_inside("<integrator type='path'><integer name='maxDepth' value='0'/></integrator>", lenient())
                .hints.max_depth,
            -1);
  EXPECT_EQ(load_inside("<integrator type='foo'><integer name='maxDepth' value='0'/></integrator>").hints.max_depth,
            -1);
  for (const char* value : {"-7", "2.5"})
    EXPECT_EQ(depth(value), std::string("test.xml:2: <integer name=\"maxDepth\">: ") + value +
                                " should be a whole number, 1 or more, or -1 for no limit");
  EXPECT_EQ(depth("-1"), "");
  for (const char* value : {"0", "-1", "-5"}) {
    const std::string count = std::string("<integer name='sampleCount' value='") + value + "'/>";
    EXPECT_EQ(
        error("<sampler type='independent'>" + count + "</sampler>"),
        std::string("test.xml:1: <integer name=\"sampleCount\">: ") + value + " should be a whole number, 1 or more");
  }
}

}  // namespace
}  // namespace ajar
