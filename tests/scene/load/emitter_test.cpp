// Emitters: parameters in both spellings, defaults, what is refused.
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

std::string emitter(const std::string& type, const std::string& inside = "") {
  return "<emitter type='" + type + "'>" + inside + "</emitter>";
}
Light light(const std::string& type, const std::string& inside = "") {
  return load_inside(emitter(type, inside)).lights.at(0);
}
const std::string turned =
    "<transform name='toWorld'><rotate y='1' angle='90'/><translate x='1' y='2' z='3'/></transform>";

TEST(Emitters, Area) {
  const Scene s = load_inside(
      "<shape type='sphere'><emitter type='area'><rgb name='radiance' value='1 2 3'/>"
      "<float name='samplingWeight' value='5'/></emitter></shape>");
  EXPECT_EQ(s.lights[0].kind, LightKind::area);
  EXPECT_RGB(s.lights[0].radiance.value, 1, 2, 3, 1e-6);
  EXPECT_FLOAT_EQ(s.lights[0].sampling_weight, 5);
  EXPECT_SAYS(error_of(emitter("area")), "belongs inside the <shape>");
  // defined at the top, named by a shape
  const Scene named = load_inside("<emitter type='area' id='e'/><shape type='sphere'><ref id='e'/></shape>");
  EXPECT_EQ(named.lights.size(), 1u);
  EXPECT_EQ(named.shapes[0].light, 0u);
}

TEST(Emitters, Constant) {
  EXPECT_RGB(light("constant").radiance.value, 1, 1, 1, 0);
  EXPECT_RGB(light("constant", "<rgb name='radiance' value='0.3'/>").radiance.value, 0.3, 0.3, 0.3, 1e-6);
}

TEST(Emitters, Envmap) {
  const std::string file = "<string name='filename' value='four.png'/>";
  const Scene s = load_inside(
      emitter("envmap", file + "<float name='scale' value='3'/>" +
                            "<transform name='to_world'><scale value='7'/><rotate y='1' angle='90'/></transform>"));
  EXPECT_EQ(s.lights[0].kind, LightKind::envmap);
  EXPECT_EQ(s.environments.size(), 1u);
  EXPECT_FLOAT_EQ(s.environments[0].scale, 3);
  EXPECT_RGB(Vec3(s.lights[0].to_world * Vec4(1, 0, 0, 0)), 0, 0, -1, 1e-6);  // without the scale
  EXPECT_SAYS(error_of(emitter("envmap")), "needs <string name=\"filename\"");
  EXPECT_SAYS(error_of(emitter("envmap", file + "<float name='scale' value='-3'/>")), "negative");
}

// The centres of the first and last row of texels are at the poles; in version 0.x they are half a row from them.
TEST(Emitters, EnvmapReachesThePoles) {
  const std::string file = write_pfm("rows.pfm", {1, 1, 1, 9, 9, 9}, 2);  // from below
  const auto seen = [&](const std::string& version) {
    const std::string map = emitter("envmap", "<string name='filename' value='" + file + "'/>");
    return environment(load_inside(map, {}, version), 0, glm::normalize(Vec3(0, 1, 1))).x;
  };
  EXPECT_NEAR(seen("3.0.0"), 7, 1e-4);
  EXPECT_NEAR(seen("2.0.0"), 7, 1e-4);
  EXPECT_NEAR(seen("0.6.0"), 9, 1e-4);
}

// Each is a number; their product is none.
TEST(Emitters, BeyondWhatNumbersHold) {
  const std::string scale = "<float name='scale' value='1e31'/>";
  const std::string map = "<string name='filename' value='" + write_pfm("bright.pfm", {5, 5, 5, 5, 1e8f, 5}) + "'/>";
  EXPECT_SAYS(error_of(emitter("envmap", map + scale)), "beyond what numbers hold");
  EXPECT_EQ(load_inside(emitter("envmap", map)).lights.size(), 1u);
  const std::string texture =
      "<texture name='radiance' type='scale'>" + scale + "<texture type='bitmap'>" + map + "</texture></texture>";
  EXPECT_SAYS(error_of("<shape type='sphere'>" + emitter("area", texture) + "</shape>"), "beyond what numbers hold");
}

TEST(Emitters, FartherThanRaysGo) {
  const std::string far = "<transform name='to_world'><translate x='1e19'/></transform>";
  for (const char* type : {"point", "spot", "projector"})
    EXPECT_SAYS(error_of(emitter(type, far)), "stands farther than 1e+18 units away; move it nearer");
}

// Maps of bright lights have negative texels after resizing, and worse after mistakes.
TEST(Emitters, EnvmapWithBadTexels) {
  const auto file = [](const std::string& path, const std::string& inside = "") {
    return emitter("envmap", "<string name='filename' value='" + path + "'/>" + inside);
  };
  const std::string dark = write_pfm("dark.pfm", {5, 5, 5, -1e-6f, 2, 3});
  for (const std::string raw : {"", "<boolean name='raw' value='true'/>"}) {
    const Scene s = load_inside(file(dark, raw));
    EXPECT_EQ(texel(s.images[s.environments[0].image], 1, 0), Rgb(0, 2, 3)) << raw;
    EXPECT_TRUE(says(s.notes, raw.empty() ? "dark.pfm: negative numbers (1 of 6) were set to 0" : "are no light"))
        << raw;
  }
  const std::string hole = write_pfm("hole.pfm", {5, 5, 5, std::nanf(""), infinity, 3});
  EXPECT_SAYS(error_of(file(hole)), "hole.pfm: pixel (1, 0) holds nan; repair the image; with --lenient: 0");
  const Scene s = load_inside(file(hole), lenient());
  EXPECT_EQ(texel(s.images[s.environments[0].image], 1, 0), Rgb(0, 0, 3));
  EXPECT_TRUE(says(s.notes, "hole.pfm: numbers that are not finite (2 of 6) were set to 0"));
}

TEST(Emitters, Point) {
  const Light l = light("point", "<point name='position' x='1' z='3'/><rgb name='intensity' value='4 5 6'/>");
  EXPECT_EQ(l.kind, LightKind::point);
  EXPECT_RGB(l.position, 1, 0, 3, 0);
  EXPECT_RGB(l.radiance.value, 4, 5, 6, 1e-6);
  EXPECT_RGB(light("point", turned).position, 1, 2, 3, 1e-6);
}

TEST(Emitters, Spot) {
  Light l = light("spot", turned + "<float name='cutoffAngle' value='60'/>");
  EXPECT_EQ(l.kind, LightKind::spot);
  EXPECT_RGB(l.position, 1, 2, 3, 1e-6);
  EXPECT_RGB(l.direction, 1, 0, 0, 1e-6);
  EXPECT_FLOAT_EQ(l.cutoff, pi / 3);
  EXPECT_FLOAT_EQ(l.beam, pi / 4);
  l = light("spot", "<float name='beam_width' value='0'/>");
  EXPECT_FLOAT_EQ(l.cutoff, pi / 9);
  EXPECT_EQ(l.beam, 0);
  EXPECT_SAYS(error_of(emitter("spot", "<float name='cutoff_angle' value='0'/>")), "cutoff_angle");
  EXPECT_SAYS(error_of(emitter("spot", "<float name='cutoff_angle' value='181'/>")), "cutoff_angle");
  EXPECT_EQ(light("spot", "<float name='cutoff_angle' value='180'/>").cutoff, pi);  // all around
  EXPECT_SAYS(error_of(emitter("spot", "<float name='beam_width' value='30'/>")), "beam_width");
  const std::string wide = emitter("spot", "<transform name='to_world'><scale x='2'/></transform>");
  EXPECT_SAYS(error_of(wide), "its to_world stretches its cone");
  for (const char* type : {"spot", "projector"})  // turns of three decimals are turns
    EXPECT_EQ(load_inside(emitter(type,
                                  "<transform name='to_world'><matrix value='0.707 0 0.707 0 0 1 0 0 -0.707 0 "
                                  "0.707 2 0 0 0 1'/></transform>"))
                  .lights.size(),
              1u);
  EXPECT_EQ(load_inside(wide, lenient()).lights.size(), 1u);
  for (const auto& [type, slot] : {std::pair("spot", "texture"), std::pair("projector", "irradiance")})
    EXPECT_SAYS(error_of(emitter(type, "<texture name='" + std::string(slot) +
                                           "' type='mesh_attribute'><string name='name' value='vertex_c'/></texture>")),
                "shows a mesh attribute, and it has no mesh");
}

// The square around the cone, u along x and v along y of the light's own space (Mitsuba's spot).
TEST(Emitters, SpotThrowsItsTexture) {
  const std::string picture =
      "<texture name='texture' type='checkerboard'><rgb name='color0' value='3'/><rgb name='color1' value='0'/>"
      "<transform name='to_uv'><scale value='0.5'/></transform></texture>";
  const std::string inside = picture +
                             "<rgb name='intensity' value='2 4 6'/><float name='cutoff_angle' value='45'/>"
                             "<float name='beam_width' value='44'/>";
  Scene s = load_inside(emitter("spot", inside));
  finish(s);
  DirectSample d;
  // to_uv halves: the board has one square on the whole picture
  ASSERT_TRUE(sample_direct(s, 0, {0.3f, 0.4f, 2}, {0.5f, 0.5f}, d));
  EXPECT_RGB(d.radiance * sqr(d.distance), 6, 12, 18, 1e-4);
  s = load_inside(emitter("spot", inside + "<transform name='to_world'><rotate y='1' angle='90'/></transform>"));
  finish(s);
  s.textures[s.textures[s.lights[0].radiance.texture].color0.texture].to_uv = Mat3(1);
  // x of the light is -z of the world: u > 1/2 and v < 1/2 make the second colour
  EXPECT_FALSE(sample_direct(s, 0, {2, -0.4f, -0.3f}, {0.5f, 0.5f}, d));
  EXPECT_TRUE(sample_direct(s, 0, {2, 0.4f, -0.3f}, {0.5f, 0.5f}, d));
  EXPECT_FALSE(sample_direct(s, 0, {2, 0.4f, 0.3f}, {0.5f, 0.5f}, d));
  EXPECT_SAYS(error_of(emitter("spot", picture + "<float name='cutoff_angle' value='100'/>")), "less than 90");
  EXPECT_RGB(light("spot", "<rgb name='texture' value='1 2 3'/><rgb name='intensity' value='2'/>").radiance.value, 2, 4,
             6, 1e-5);
}

// A screen across the axis is lit evenly by pi times the irradiance, whose first row is above.
TEST(Emitters, Projector) {
  const std::string picture =
      "<texture name='irradiance' type='checkerboard'><rgb name='color0' value='2 4 6'/>"
      "<rgb name='color1' value='0'/></texture>";
  Scene s =
      load_inside(emitter("projector", picture + "<float name='fov' value='90'/><float name='scale' value='3'/>"));
  finish(s);
  EXPECT_RGB(Vec3(s.lights[0].plane, 0), 1, 1, 0, 1e-6);
  DirectSample d;
  for (const Vec3& x : {Vec3(0.9f, 0.8f, 1), Vec3(-0.2f, -0.1f, 1)}) {  // left above, right below
    ASSERT_TRUE(sample_direct(s, 0, x, {0.5f, 0.5f}, d));
    EXPECT_RGB(d.radiance * -d.wi.z, 6 * pi, 12 * pi, 18 * pi, 1e-3);
  }
  for (const Vec3& x : {Vec3(-0.9f, 0.8f, 1), Vec3(1.1f, 0, 1), Vec3(0.5f, 0.5f, -1)})
    EXPECT_FALSE(sample_direct(s, 0, x, {0.5f, 0.5f}, d));
  // the picture's shape, turned and moved
  s = load_inside(emitter("projector", turned + "<float name='fov' value='90'/><string name='fov_axis' value='y'/>"
                                                "<texture name='irradiance' type='bitmap'><string name='filename' "
                                                "value='alpha.png'/></texture>"));
  const Image& image = s.images[0];
  EXPECT_RGB(Vec3(s.lights[0].plane, 0), double(image.width) / image.height, 1, 0, 1e-6);
  EXPECT_RGB(s.lights[0].position, 1, 2, 3, 1e-6);
  EXPECT_RGB(s.lights[0].direction, 1, 0, 0, 1e-6);
  EXPECT_SAYS(error_of(emitter("projector", "<transform name='to_world'><scale x='2'/></transform>")), "not stretch");
}

TEST(Emitters, Directional) {
  const Light l =
      light("directional", "<vector name='direction' x='0' y='-2' z='0'/><rgb name='irradiance' value='2'/>");
  EXPECT_EQ(l.kind, LightKind::directional);
  EXPECT_RGB(l.direction, 0, -1, 0, 1e-6);
  EXPECT_RGB(l.radiance.value, 2, 2, 2, 1e-6);
  EXPECT_RGB(light("directional", turned).direction, 1, 0, 0, 1e-6);
  EXPECT_SAYS(error_of(emitter("directional", "<vector name='direction' value='0, 0, 0'/>")), "zero vector");
}

Scene old(const std::string& inside) { return load_inside(inside, {}, "0.6.0"); }
Light read_old(const std::string& type, const std::string& inside) { return old(emitter(type, inside)).lights.at(0); }
std::string sun_at(const std::string& direction) { return "<vector name='sunDirection' value='" + direction + "'/>"; }

TEST(Emitters, SunAndSky) {
  const std::string high = "<vector name='sunDirection' value='0 1 1'/>";
  const Scene both = old(emitter("sunsky", high + "<float name='skyScale' value='2'/>"));
  ASSERT_EQ(both.lights.size(), 2u);
  EXPECT_EQ(both.lights[0].kind, LightKind::envmap);
  EXPECT_EQ(both.lights[1].kind, LightKind::sun);
  EXPECT_RGB(both.lights[1].direction, 0, -std::sqrt(0.5f), -std::sqrt(0.5f), 1e-5);
  // Of one size without the scale: across the beam the sun gives somewhat more than the whole sky does.
  EXPECT_GT(power(both, 1), 0.5f * power(both, 0));
  EXPECT_LT(power(both, 1), 5 * power(both, 0));
  EXPECT_NEAR(power(both, 0) / power(old(emitter("sky", high)), 0), 2, 1e-3);
  // A larger disc, as much light.
  const Scene wide = old(emitter("sun", high + "<float name='sunRadiusScale' value='10'/>"));
  EXPECT_NEAR(power(wide, 0) / power(old(emitter("sun", high)), 0), 1, 1e-3);
  // Low suns are redder.
  const Rgb noon = read_old("sun", "<vector name='sunDirection' value='0 1 0'/>").radiance.value,
            evening = read_old("sun", "<vector name='sunDirection' value='1 0.1 0'/>").radiance.value;
  EXPECT_GT(evening.x / evening.z, 2 * noon.x / noon.z);
  // Midsummer noon in Oslo: 53.5 degrees high, in the south (+z).
  const Light oslo = read_old("sun",
                              "<integer name='month' value='6'/><integer name='day' value='21'/><float name='hour' "
                              "value='12'/><float name='minute' value='19'/><float name='timezone' value='1'/><float "
                              "name='latitude' value='59.91'/><float name='longitude' value='10.75'/>");
  EXPECT_NEAR(-oslo.direction.y, std::sin(glm::radians(53.5f)), 0.01f);
  EXPECT_GT(-oslo.direction.z, 0.55f);
  EXPECT_SAYS(kit::error_of([] { old(emitter("sunsky", sun_at("0 -1 0"))); }), "below the horizon");
  // Stretched, the horizon is as far below as the zenith is above, and the sun, at 45 degrees, stands at 67.5.
  const auto below = [](const std::string& inside) {
    const Scene s = old(emitter("sky", "<vector name='sunDirection' value='0 1 1'/>" + inside));
    return luminance(environment(s, 0, glm::normalize(Vec3(1, -0.5f, 0.3f))));
  };
  EXPECT_EQ(below(""), 0);
  EXPECT_GT(below("<float name='stretch' value='2'/>"), 0);
  const auto extended = [](float y) {  // at this height, by the horizon
    const Scene s = old(emitter("sky",
                                "<vector name='sunDirection' value='0 1 1'/><boolean name='extend' "
                                "value='true'/><integer name='resolution' value='1024'/>"));
    const auto at = [&](float height) {
      return luminance(environment(s, 0, glm::normalize(Vec3(std::sqrt(1 - height * height), height, 0))));
    };
    return at(y) / at(-0.01f);
  };
  EXPECT_NEAR(extended(-std::sqrt(0.5f)), 0.5f, 0.01f);
  EXPECT_NEAR(extended(-std::sin(glm::radians(67.5f))), 0.156f, 0.01f);
  EXPECT_NEAR(read_old("sun", high + "<float name='stretch' value='1.5'/>").direction.y, -std::cos(glm::radians(67.5f)),
              1e-5f);
  EXPECT_SAYS(kit::error_of([&] { old(emitter("sky", high + "<float name='stretch' value='3'/>")); }),
              "stretch should be");
  const Scene night = load_inside(emitter("sunsky", sun_at("0 0 -1") + "<float name='sun_aperture' value='1'/>"));
  EXPECT_TRUE(night.lights.empty());
  EXPECT_TRUE(says(night.notes, "neither it nor the sky shines"));
  EXPECT_FALSE(says(night.notes, "sun_aperture"));
  EXPECT_EQ(old(emitter("sunsky", sun_at("1 0 0"))).lights.size(), 2u);  // on the horizon
  EXPECT_SAYS(error_of(emitter("sky", high + "<float name='turbidity' value='0'/>")), "turbidity");
}

// The sun stands where it is said to, however the sky is turned.
TEST(Emitters, SunDirectionIsOfTheWorld) {
  const std::string lying = "<transform name='toWorld'><rotate x='1' angle='90'/></transform>";  // +y to +z
  const Scene s = old(emitter("sunsky", sun_at("0 0.5 1") + lying));
  const Vec3 towards = glm::normalize(Vec3(0, 0.5f, 1));
  EXPECT_RGB(s.lights[1].direction, -towards.x, -towards.y, -towards.z, 1e-6);
  EXPECT_EQ(environment(s, 0, {0, 0, -1}), Rgb(0));
  EXPECT_EQ(environment(s, 0, glm::normalize(Vec3(0, 0.5f, -0.1f))), Rgb(0));
  EXPECT_GT(environment(s, 0, {0, 0, 1}).y, 0);
  EXPECT_GT(environment(s, 0, towards).y, 3 * environment(s, 0, glm::normalize(Vec3(0, -0.5f, 1))).y);
  EXPECT_SAYS(error_of(emitter("sun", "<transform name='toWorld'><scale x='0'/></transform>")), "singular");
}

TEST(Emitters, SkiesOfNewFilesHaveZUp) {
  const Scene z = load_inside(emitter("sunsky", sun_at("1 0.2 0.5"))), y = old(emitter("sunsky", sun_at("1 0.5 -0.2")));
  EXPECT_RGB(z.lights[1].radiance.value / y.lights[1].radiance.value, 1, 1, 1, 1e-6);
  EXPECT_EQ(environment(z, 0, {0, 0, -1}), Rgb(0));
  for (const Vec3& w : {Vec3(0, 0.6f, 0.8f), Vec3(0.8f, 0, 0.6f), Vec3(0, 0, 1)})
    EXPECT_RGB(environment(z, 0, w) / environment(y, 0, {w.x, w.z, -w.y}), 1, 1, 1, 1e-4);
  // A file that turns it upright: the sky of an old one.
  const Scene turned_up = load_inside(
      emitter("sunsky", sun_at("1 0.5 -0.2") + "<transform name='to_world'><rotate x='1' angle='-90'/></transform>"));
  EXPECT_RGB(environment(turned_up, 0, {0, 0.6f, 0.8f}) / environment(y, 0, {0, 0.6f, 0.8f}), 1, 1, 1, 1e-5);
  // North is +x, east +y: noon in Oslo again.
  const Light oslo = light("sun",
                           "<integer name='month' value='6'/><integer name='day' value='21'/><float name='hour' "
                           "value='12'/><float name='minute' value='19'/><float name='timezone' value='1'/><float "
                           "name='latitude' value='59.91'/><float name='longitude' value='10.75'/>");
  EXPECT_RGB(-oslo.direction, -std::cos(glm::radians(53.5)), 0, std::sin(glm::radians(53.5)), 0.02);
}

TEST(Emitters, SunOfAnySizeGivesTheSameLight) {
  const auto sun = [](const std::string& name, const std::string& value) {
    return read_old("sun", sun_at("0 1 1") + "<float name='" + name + "' value='" + value + "'/>");
  };
  const auto solid_angle = [](const Light& l) { return 2 * std::numbers::pi_v<float> * l.cone; };
  const Light own = sun("sunRadiusScale", "1"), wide = sun("sun_aperture", "5"), none = sun("sunRadiusScale", "0");
  EXPECT_NEAR(wide.cone, 1 - std::cos(glm::radians(2.5)), 1e-8);
  EXPECT_NEAR(wide.radiance.value.y * solid_angle(wide) / (own.radiance.value.y * solid_angle(own)), 1, 1e-4);
  EXPECT_EQ(none.kind, LightKind::directional);
  EXPECT_NEAR(none.radiance.value.y / (own.radiance.value.y * solid_angle(own)), 1, 1e-4);
  EXPECT_EQ(none.direction, own.direction);
  EXPECT_EQ(sun("sun_aperture", "0").kind, LightKind::directional);
  EXPECT_SAYS(error_of(emitter("sun", "<float name='sunRadiusScale' value='-1'/>")), "should not be negative");
  EXPECT_SAYS(error_of(emitter("sun", "<float name='sun_aperture' value='130'/>")), "smaller than 120 degrees");
}

// scale stands for those of sky and sun that are not given.
TEST(Emitters, ScaleOfSunsky) {
  const auto scaled = [](const std::string& name, const std::string& value) {
    return "<float name='" + name + "' value='" + value + "'/>";
  };
  const Scene one = old(emitter("sunsky", sun_at("0 1 1"))),
              s = old(emitter("sunsky", sun_at("0 1 1") + scaled("scale", "2") + scaled("skyScale", "3")));
  EXPECT_NEAR(power(s, 0) / power(one, 0), 3, 1e-4);
  EXPECT_NEAR(power(s, 1) / power(one, 1), 2, 1e-4);
  EXPECT_TRUE(
      says(load_inside(emitter("sky", scaled("albedo_of_ground", "2"))).notes, "\"albedo_of_ground\" is not used"));
}

TEST(Emitters, UnknownOnesInShapes) {
  EXPECT_SAYS(error_of("<shape type='sphere'>" + emitter("angulararea") + "</shape>"),
              "unknown emitter; supported: area");
  EXPECT_SAYS(error_of("<shape type='sphere'>" + emitter("point") + "</shape>"), "only an area light can be inside");
}

// Below turbidity 2 the model of the sky ends: its luminance passes through 0, and grows without bounds.
TEST(Emitters, ClearSkiesAreThoseOfTheClearest) {
  const auto sky = [](const char* turbidity) {
    return load_inside(std::string("<emitter type='sky'><float name='turbidity' value='") + turbidity +
                       "'/></emitter>");
  };
  const Scene clearest = sky("2");
  EXPECT_FALSE(says(clearest.notes, "turbidity"));
  for (const char* turbidity : {"1", "1.1", "1.6", "1.9"}) {
    const Scene s = sky(turbidity);
    EXPECT_EQ(s.images.at(0).floats, clearest.images.at(0).floats) << turbidity;
    EXPECT_TRUE(says(s.notes, "the sky is that of turbidity 2")) << turbidity;
  }
}

// Behind so much air no blue is left, and less than none of it in sRGB: that must not take the red with it.
TEST(Emitters, LowSunIsRed) {
  for (const char* turbidity : {"3", "5.2", "8"})
    for (const char* height : {"0.05", "0.1", "0.3"}) {
      const Rgb sun = light("sun", std::string("<float name='turbidity' value='") + turbidity +
                                       "'/><vector name='sun_direction' x='1.5' y='0.5' z='" + height + "'/>")
                          .radiance.value;
      EXPECT_GT(sun.x, 0) << turbidity << ' ' << height;
      EXPECT_GE(sun.x, sun.y);
      EXPECT_GE(sun.y, sun.z);
      EXPECT_GE(sun.z, 0);
    }
}

TEST(Emitters, DaylightWhereOldScenesHaveNone) {
  const Scene s = load_inside("<shape type='cube'/>", {}, "0.6.0");
  ASSERT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[0].kind, LightKind::envmap);
  EXPECT_EQ(s.lights[1].kind, LightKind::sun);
  EXPECT_TRUE(says(s.notes, "sun and sky were added"));
  EXPECT_EQ(load_inside("<emitter type='point'/>", {}, "0.6.0").lights.size(), 1u);
  // not where one was left out
  for (const char* text : {"<emitter type='ies'/>", "<shape type='hair'><emitter type='area'/></shape>"}) {
    const Scene dark = load_inside(text, lenient(), "0.6.0");
    EXPECT_TRUE(dark.lights.empty()) << text;
    EXPECT_TRUE(says(dark.notes, "the image will be black")) << text;
  }
}

TEST(Emitters, UnknownOnes) {
  for (const char* type : {"collimated", "ies"}) {
    EXPECT_SAYS(error_of(emitter(type)), "unknown emitter; supported: area, envmap");
    EXPECT_TRUE(load_inside(emitter(type), lenient()).lights.empty());
  }
  EXPECT_SAYS(error_of(emitter("constant", "<float name='sampling_weight' value='-1'/>")), "sampling_weight");
  EXPECT_TRUE(says(load_inside("<shape type='cube'/>").notes, "no light"));
  EXPECT_TRUE(says(load_inside("").notes, "no shapes"));
}

}  // namespace
}  // namespace ajar
