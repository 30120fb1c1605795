// Textures and images.
#include <OpenImageIO/imageio.h>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

Scene with(const std::string& texture) { return load_inside("<bsdf type='diffuse'>" + texture + "</bsdf>"); }
std::string bitmap(const std::string& inside = "", const std::string& tag = "texture") {
  return "<" + tag + " name='reflectance' type='bitmap'><string name='filename' value='four.png'/>" + inside + "</" +
         tag + ">";
}
// Value at (u, v) of the first bsdf's reflectance.
Rgb at(const Scene& scene, float u, float v) {
  Surface surface;
  surface.uv = {u, v};
  return eval(scene, scene.materials[0].reflectance, surface);
}
const std::string nearest = "<string name='filter_type' value='nearest'/>";

TEST(TextureFile, TopRowIsAtVZero) {
  const Scene s = with(bitmap(nearest));
  EXPECT_RGB(at(s, 0.25f, 0.25f), 1, 0, 0, 1e-6);
  EXPECT_RGB(at(s, 0.75f, 0.25f), 0, 1, 0, 1e-6);
  EXPECT_RGB(at(s, 0.25f, 0.75f), 0, 0, 1, 1e-6);
  EXPECT_RGB(at(s, 0.75f, 0.75f), 1, 1, 1, 1e-6);
}

TEST(TextureFile, LayerThatIsShownIsTold) {
  const std::string path = testing::TempDir() + "layers.exr";
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"View.B", "View.G", "View.R"};
  const float values[3] = {0.1f, 0.2f, 0.3f};
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values) && out->close());
  const Scene s =
      with("<texture name='reflectance' type='bitmap'><string name='filename' value='" + path + "'/></texture>");
  EXPECT_RGB(at(s, 0.5f, 0.5f), 0.3, 0.2, 0.1, 1e-6);
  EXPECT_TRUE(says(s.notes, "has no channels R, G and B: View.R, View.G, View.B are shown in their place"));
}

// An OBJ file counts v from below, and is turned when it is read: the upper row of the image is up.
TEST(TextureFile, StandsUprightOnObj) {
  const std::string shape = "<shape type='obj'><string name='filename' value='two words.obj'/>";
  EXPECT_FLOAT_EQ(load_inside(shape + "</shape>").meshes[0].uvs[2].y, 0);  // vt 0 1
  EXPECT_FLOAT_EQ(load_inside(shape + "<boolean name='flipTexCoords' value='false'/></shape>").meshes[0].uvs[2].y, 1);
}

TEST(TextureFile, ScaleOffsetAndTransform) {
  const Scene old = with(bitmap(nearest + "<float name='uscale' value='0.5'/><float name='voffset' value='0.5'/>"));
  EXPECT_RGB(at(old, 0.75f, 0.25f), 0, 0, 1, 1e-6);  // u 0.375, v 0.75
  const auto moved = [&](const std::string& version) {
    return load_inside("<bsdf type='diffuse'>" +
                           bitmap("<float name='uscale' value='2'/><float name='uoffset' value='.25'/>") + "</bsdf>",
                       {}, version)
        .textures.at(0)
        .to_uv;
  };
  EXPECT_EQ(moved("0.6.0") * Vec3(1, 0, 1), Vec3(2.25f, 0, 1));
  EXPECT_EQ(moved("2.0.0") * Vec3(1, 0, 1), Vec3(2.5f, 0, 1));  // in Mitsuba 2 and 3 what is moved is scaled
  const Scene steps =
      with(bitmap(nearest + "<transform name='to_uv'><scale x='0.5'/><translate y='0.5'/></transform>"));
  EXPECT_RGB(at(steps, 0.75f, 0.25f), 0, 0, 1, 1e-6);
  const Scene matrix =
      with(bitmap(nearest + "<transform name='to_uv'><matrix value='.5 0 0 0 1 .5 0 0 1'/></transform>"));
  EXPECT_RGB(at(matrix, 0.75f, 0.25f), 0, 0, 1, 1e-6);
  const Scene turned = with(bitmap(nearest + "<transform name='toUv'><rotate z='1' angle='90'/></transform>"));
  EXPECT_RGB(at(turned, 0.25f, 0.25f), 0, 1, 0, 1e-6);  // (u, v) -> (-v, u) = (-0.25, 0.25) -> u 0.75
}

TEST(TextureFile, WrapAndFilter) {
  Texture t =
      with(bitmap("<string name='wrapMode' value='clamp'/><string name='filterType' value='trilinear'/>")).textures[0];
  EXPECT_EQ(t.wrap_u, Wrap::clamp);
  EXPECT_EQ(t.wrap_v, Wrap::clamp);
  EXPECT_FALSE(t.nearest);
  t = with(bitmap("<string name='wrapModeU' value='mirror'/>")).textures[0];
  EXPECT_EQ(t.wrap_u, Wrap::mirror);
  EXPECT_EQ(t.wrap_v, Wrap::repeat);
  const Scene anisotropic =
      with(bitmap("<string name='filter_type' value='anisotropic'/><float name='max_anisotropy' value='8'/>"));
  EXPECT_FALSE(anisotropic.textures[0].nearest);
  EXPECT_FALSE(says(anisotropic.notes, "anisotropy"));
  EXPECT_SAYS(error_of("<bsdf type='diffuse'>" + bitmap("<string name='wrap_mode' value='twist'/>") + "</bsdf>"),
              "known are repeat, mirror, clamp, zero, one");
}

TEST(TextureFile, RawGammaAndChannel) {
  EXPECT_NEAR(with(bitmap()).images[0].decode[128], 0.21586, 1e-4);
  EXPECT_NEAR(with(bitmap("<boolean name='raw' value='true'/>")).images[0].decode[128], 128 / 255.0, 1e-6);
  EXPECT_NEAR(with(bitmap("<float name='gamma' value='1'/>")).images[0].decode[128], 128 / 255.0, 1e-6);
  EXPECT_NEAR(with(bitmap("<float name='gamma' value='2.2'/>")).images[0].decode[128], std::pow(128 / 255.0, 2.2),
              1e-5);
  EXPECT_EQ(with(bitmap("<string name='channel' value='g'/>")).textures[0].channel, Channel::green);
  EXPECT_EQ(with(bitmap("<string name='channel' value='a'/>")).textures[0].channel, Channel::alpha);
}

// linear.png says that its gamma is 1.
TEST(TextureFile, GammaOfAPngCountsInOldScenes) {
  const std::string text =
      "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string name='filename' value='linear.png'/>"
      "</texture></bsdf>";
  EXPECT_NEAR(load_inside(text, {}, "0.6.0").images[0].decode[128], 128 / 255.0, 1e-6);
  std::string srgb = text;
  srgb.insert(srgb.find("</texture>"), "<float name='gamma' value='-1'/>");
  EXPECT_NEAR(load_inside(srgb, {}, "0.6.0").images[0].decode[128], 0.21586, 1e-4);
  EXPECT_NEAR(load_inside(text).images[0].decode[128], 0.21586, 1e-4);
}

TEST(TextureFile, IsReadOnce) {
  const Scene s =
      load_inside("<bsdf type='diffuse'>" + bitmap() + "</bsdf><bsdf type='diffuse'>" + bitmap() + "</bsdf>" +
                  "<bsdf type='diffuse'>" + bitmap("<boolean name='raw' value='true'/>") + "</bsdf>");
  EXPECT_EQ(s.textures.size(), 3u);
  EXPECT_EQ(s.images.size(), 2u);
}

TEST(TextureFile, SpectrumMayNameATexture) {
  EXPECT_NE(with(bitmap("", "spectrum")).materials[0].reflectance.texture, none);
}

TEST(TextureFile, MissingOnesAreErrors) {
  const auto error = [](const std::string& inside) {
    return error_of("<bsdf type='diffuse'><texture name='reflectance' type='bitmap'>" + inside + "</texture></bsdf>");
  };
  EXPECT_SAYS(error(""), "needs <string name=\"filename\"");
  EXPECT_SAYS(error("<string name='filename' value='none.png'/>"),
              "test.xml:2: <string name=\"filename\">: there is no file \"none.png\"");
  EXPECT_SAYS(error("<string name='filename' value='fragment.xml'/>"), "fragment.xml: cannot be read as an image");
}

TEST(TextureKinds, Checkerboard) {
  const Scene s = with(
      "<texture name='reflectance' type='checkerboard'><rgb name='color0' value='.1'/>"
      "<rgb name='color1' value='.9'/><transform name='to_uv'><scale x='2' y='2'/></transform></texture>");
  EXPECT_RGB(at(s, 0.1f, 0.1f), 0.1, 0.1, 0.1, 1e-6);
  EXPECT_RGB(at(s, 0.3f, 0.1f), 0.9, 0.9, 0.9, 1e-6);
  EXPECT_RGB(at(with("<texture name='reflectance' type='checkerboard'/>"), 0.1f, 0.1f), 0.4, 0.4, 0.4, 1e-6);
  EXPECT_RGB(at(with("<texture name='reflectance' type='checkerboard'/>"), 0.6f, 0.1f), 0.2, 0.2, 0.2, 1e-6);
}

// Mitsuba 0.6 cuts coordinates to whole numbers.
TEST(TextureKinds, CheckerboardsOfTheOlderVersionAreMirroredAtZero) {
  const std::string text = "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'/></bsdf>";
  const Scene old = load_inside(text, {}, "0.6.0"), later = load_inside(text);
  EXPECT_RGB(at(old, -0.1f, 0.1f), 0.4, 0.4, 0.4, 1e-6);
  EXPECT_RGB(at(old, -0.1f, -0.7f), 0.2, 0.2, 0.2, 1e-6);
  EXPECT_RGB(at(old, -1.6f, -0.7f), 0.4, 0.4, 0.4, 1e-6);
  EXPECT_RGB(at(later, -0.1f, 0.1f), 0.2, 0.2, 0.2, 1e-6);
}

TEST(TextureKinds, Grid) {
  const auto grid = [](const std::string& inside) {
    return with("<texture name='reflectance' type='gridtexture'>" + inside + "</texture>");
  };
  Scene s = grid("");
  for (const float edge : {0.0f, 0.009f, 0.991f, 3.995f}) {
    EXPECT_RGB(at(s, edge, 0.5f), 0.4, 0.4, 0.4, 1e-6);
    EXPECT_RGB(at(s, 0.5f, edge), 0.4, 0.4, 0.4, 1e-6);
  }
  for (const float inside : {0.011f, 0.5f, 0.989f}) EXPECT_RGB(at(s, inside, inside), 0.2, 0.2, 0.2, 1e-6);
  EXPECT_RGB(mean(s, s.materials[0].reflectance), 0.20792, 0.20792, 0.20792, 1e-6);  // 0.98 * 0.98 of it ground
  s = grid(
      "<rgb name='color0' value='.1 .2 .3'/><rgb name='color1' value='.9'/><float name='lineWidth' value='.25'/>"
      "<float name='uvscale' value='2'/><float name='uoffset' value='.25'/><string name='filterType' value='ewa'/>");
  EXPECT_EQ(s.notes.size(), 2u);                        // no shape, no light
  EXPECT_RGB(at(s, 0, 0.25f), 0.1, 0.2, 0.3, 1e-6);     // u 0.5, v 0.5
  EXPECT_RGB(at(s, 0.2f, 0.25f), 0.9, 0.9, 0.9, 1e-6);  // u 0.9
  EXPECT_RGB(at(s, 0, 0.1f), 0.9, 0.9, 0.9, 1e-6);      // v 0.2
  EXPECT_SAYS(error_of("<bsdf type='diffuse'><texture name='reflectance' type='gridtexture'><float name='lineWidth' "
                       "value='-1'/></texture></bsdf>"),
              "line_width should not be negative");
}

TEST(TextureKinds, LightsMayBeBrighterThanSurfaces) {
  const std::string checker = "<texture id='t' type='checkerboard'><rgb name='color0' value='30'/></texture>";
  const Scene s = load_inside(checker +
                              "<shape type='sphere'><emitter type='area'><ref name='radiance' id='t'/></emitter>"
                              "<bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf></shape>");
  EXPECT_FLOAT_EQ(s.textures[s.lights[0].radiance.texture].color0.value.x, 30);
  EXPECT_FLOAT_EQ(s.textures[s.materials[0].reflectance.texture].color0.value.x, 1);
}

TEST(TextureKinds, Scale) {
  const Scene s = with(
      "<texture name='diffuseReflectance' type='scale'><float name='scale' value='0.5'/>"
      "<texture type='checkerboard'/></texture>");
  EXPECT_RGB(at(s, 0.1f, 0.1f), 0.2, 0.2, 0.2, 1e-6);
  EXPECT_SAYS(error_of("<bsdf type='diffuse'><texture name='reflectance' type='scale'/></bsdf>"),
              "needs a nested <texture>");
}

std::string shown(const std::string& path, const std::string& inside = "") {
  return "<texture name='reflectance' type='bitmap'><string name='filename' value='" + path + "'/>" + nearest + inside +
         "</texture>";
}

// Reflectances above 1 would make light from nothing, wherever they come from.
TEST(Limits, BitmapsShowAtMostOne) {
  const std::string path = write_pfm("bright.pfm", {0.5f, 1.2f, 0.25f, 0.1f, 0.2f, 3});
  const Scene s = with(shown(path));
  EXPECT_RGB(at(s, 0.25f, 0.5f), 0.5, 1, 0.25, 0);
  EXPECT_RGB(at(s, 0.75f, 0.5f), 0.1f, 0.2f, 1, 0);
  EXPECT_TRUE(says(s.notes, "bright.pfm: numbers below 0 or above 1 are no reflectances: they were set to 0 or 1"));
  // a lamp shows all of the same file
  const Scene both = load_inside("<bsdf type='diffuse'>" + shown(path) + "</bsdf><bsdf type='diffuse'>" + shown(path) +
                                 "</bsdf><shape type='sphere'><emitter type='area'><texture name='radiance' "
                                 "type='bitmap'><string name='filename' value='" +
                                 path + "'/>" + nearest + "</texture></emitter></shape>");
  EXPECT_EQ(both.images.size(), 2u);
  EXPECT_RGB(at(both, 0.75f, 0.5f), 0.1f, 0.2f, 1, 0);
  Surface surface;
  surface.uv = {0.75f, 0.5f};
  EXPECT_RGB(eval(both, both.lights[0].radiance, surface), 0.1f, 0.2f, 3, 0);
  EXPECT_EQ(with(shown(write_pfm("dim.pfm", {0.5f, 1, 0}))).images.size(), 1u);
}

TEST(Limits, ProductsShowAtMostOne) {
  const auto scaled = [](const std::string& by, const std::string& inside) {
    return with("<texture name='reflectance' type='scale'><float name='scale' value='" + by + "'/>" + inside +
                "</texture>");
  };
  Scene s = scaled("2", "<rgb name='v' value='0.9 0.4 0.1'/>");
  EXPECT_RGB(at(s, 0, 0), 1, 0.8f, 0.2f, 1e-6);
  EXPECT_RGB(mean(s, s.materials[0].reflectance), 1, 0.8f, 0.2f, 1e-6);
  EXPECT_TRUE(says(s.notes, "reflectances above 1 would make light from nothing"));
  s = scaled("2", "<texture type='checkerboard'/>");
  EXPECT_RGB(at(s, 0.1f, 0.1f), 0.8f, 0.8f, 0.8f, 1e-6);
  EXPECT_EQ(s.textures.size(), 2u) << "no limit where none is needed";
  EXPECT_FALSE(says(s.notes, "above 1"));
  // what is scaled has no limit of its own
  s = scaled("0.5", "<texture type='checkerboard'><rgb name='color0' value='1.6'/></texture>");
  EXPECT_RGB(at(s, 0.1f, 0.1f), 0.8f, 0.8f, 0.8f, 1e-6);
  s = scaled("0.25", shown(write_pfm("bright.pfm", {3, 1.2f, 0.4f})));
  EXPECT_RGB(at(s, 0.5f, 0.5f), 0.75f, 0.3f, 0.1f, 1e-6);
  EXPECT_FALSE(says(s.notes, "above 1"));
}

std::string coloured(double scale) {
  return "<shape type='ply'><string name='filename' value='coloured.ply'/><bsdf type='diffuse'>"
         "<texture name='reflectance' type='mesh_attribute'><string name='name' value='vertex_color'/>"
         "<float name='scale' value='" +
         std::to_string(scale) + "'/></texture></bsdf></shape>";
}

TEST(Limits, MeshAttributesShowAtMostOne) {
  Surface surface;
  surface.shape = 0;
  surface.bary = {1, 0};
  Scene s = load_inside(coloured(2));
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 1, 0, 0);
  EXPECT_TRUE(says(s.notes, "its mesh attributes make reflectances above 1: there they become 1"));
  s = load_inside(coloured(0.5));
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 0.5, 0, 0);
  EXPECT_FALSE(says(s.notes, "above 1"));
}

TEST(Limits, MeshAttributesOfLampsAreNotNegative) {
  const Scene s = load_inside(
      "<shape type='ply'><string name='filename' value='debts.ply'/><emitter type='area'>"
      "<texture name='radiance' type='vertexcolors'/></emitter></shape>");
  Surface surface;
  surface.shape = 0;
  EXPECT_RGB(eval(s, s.lights[0].radiance, surface), 0, 2, 3, 1e-6);
  EXPECT_RGB(mean(s, s.lights[0].radiance), 0, 2, 3, 1e-6);
  EXPECT_TRUE(says(s.notes, "the mesh attribute \"vertex_color\" has negative numbers: they show as 0"));
}

TEST(TextureKinds, MeshAttribute) {
  for (const char* type : {"mesh_attribute'><string name='name' value='vertex_color'/></texture>", "vertexcolors'/>"}) {
    const Scene s =
        load_inside(std::string("<shape type='ply'><string name='filename' value='coloured.ply'/><bsdf type='diffuse'>"
                                "<texture name='reflectance' type='") +
                    type + "</bsdf></shape>");
    EXPECT_EQ(s.textures[0].kind, TextureKind::mesh_attribute);
    Surface surface;
    surface.shape = 0;
    surface.bary = {1, 0};
    EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 1, 0, 1e-6);
    EXPECT_RGB(mean(s, s.materials[0].reflectance), 1.0 / 3, 1.0 / 3, 1.0 / 3, 1e-6);
  }
}

std::string with_attribute(const std::string& shape, const std::string& name, const std::string& inside = "") {
  return "<shape type='" + shape + "'><string name='filename' value='attributes.ply'/>" + inside +
         "<bsdf type='twosided'><bsdf type='diffuse'><texture name='reflectance' type='scale'><texture "
         "type='mesh_attribute'><string name='name' value='" +
         name + "'/></texture><float name='scale' value='0.5'/></texture></bsdf></bsdf></shape>";
}

TEST(TextureKinds, AttributesOfFacesAndVertices) {
  Surface surface;
  surface.shape = 0;
  surface.prim = 1;
  surface.bary = {0, 0.5f};
  Scene s = load_inside(with_attribute("ply", "face_color"));
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 0.5, 0.016552, 1e-6);  // bytes: sRGB
  s = load_inside(with_attribute("ply", "vertex_heat"));
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0.25, 0.25, 0.25, 1e-6);
  for (Attribute& a : s.meshes[0].attributes)
    for (Rgb& c : a.values) c = -c;
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 0, 0, 0);
  EXPECT_SAYS(error_of("<bsdf type='diffuse'><texture name='reflectance' type='mesh_attribute'>"
                       "<string name='name' value='vertex_color'/><float name='scale' value='-1'/></texture></bsdf>"),
              "scale should not be negative");
  // what is not there
  EXPECT_SAYS(error_of(with_attribute("ply", "vertex_color")),
              "test.xml:2: <shape type=\"ply\">: its textures show the mesh attribute \"vertex_color\", which it "
              "lacks; it has face_color, vertex_bad, vertex_heat");
  EXPECT_SAYS(error_of(with_attribute("sphere", "face_color")), "it has none");
  s = load_inside(with_attribute("ply", "face_colour"), lenient());
  EXPECT_RGB(eval(s, s.materials[0].reflectance, surface), 0, 0, 0, 0);
  EXPECT_SAYS(error_of(with_attribute("ply", "vertex_bad")), "not finite");
  EXPECT_SAYS(error_of(with_attribute("ply", "color")), "begins with vertex_ or face_");
  EXPECT_SAYS(error_of("<shape type='rectangle'><emitter type='area'><texture name='radiance' type='mesh_attribute'>"
                       "<string name='name' value='face_glow'/></texture></emitter></shape>"),
              "face_glow");
}

TEST(TextureKinds, Unknown) {
  const std::string text = "<bsdf type='diffuse'><texture name='reflectance' type='curvature'/></bsdf>";
  EXPECT_SAYS(error_of(text), "unknown texture; supported: bitmap, checkerboard");
  EXPECT_RGB(at(load_inside(text, lenient()), 0.1f, 0.6f), 0.5, 0.5, 0.5, 1e-6);
}

}  // namespace
}  // namespace ajar
