// Material libraries: what is in them, and the parts that an obj of version 0.x becomes by them.
#include "scene/load/mtl.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/load/loader.h"
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

MtlMaterial material(const std::string& lines) { return parse_mtl("newmtl m\n" + lines, "a.mtl").materials.at(0); }

std::string mtl_error(const std::string& text) {
  try {
    parse_mtl(text, "a.mtl");
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(Mtl, NumbersAndColours) {
  const MtlMaterial m = material(" Kd .1 .2 .3 # comment\r\n\tKs 0.5\r\nNs 60\nNi 1.4\nillum 7\nd 0.75\n");
  EXPECT_EQ(m.name, "m");
  EXPECT_EQ(m.diffuse, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(m.specular, Rgb(0.5f));
  EXPECT_TRUE(m.has_specular);
  EXPECT_EQ(m.exponent, 60);
  EXPECT_EQ(m.ior, 1.4f);
  EXPECT_EQ(m.illum, 7);
  EXPECT_EQ(m.opacity, 0.75f);
  EXPECT_EQ(material("Tr 0.9\nd 0.5\nTr 0.9").opacity, 0.5f) << "some exporters mean d by Tr";
  EXPECT_EQ(material("Tr 0.9").opacity, 1);
  EXPECT_EQ(material("").illum, 0);
  EXPECT_EQ(material("").diffuse, Rgb(0));
  EXPECT_EQ(material("d -halo 0.5").opacity, 0.5f);
  EXPECT_EQ(material("Ns -1.960784").exponent, 0);
}

TEST(Mtl, Maps) {
  MtlMap map = material("map_Kd wood with blanks.png").map_diffuse;
  EXPECT_EQ(map.file, "wood with blanks.png");
  EXPECT_EQ(map.scale, Vec2(1));
  map = material("map_Kd -blendu on -s 2 3 1 -o .5 -t 1 1 -mm 0 1 -clamp on -imfchan g 4 walls.png").map_diffuse;
  EXPECT_EQ(map.file, "4 walls.png");
  EXPECT_EQ(map.scale, Vec2(2, 3));
  EXPECT_EQ(map.offset, Vec2(0.5f, 0));
  EXPECT_TRUE(map.clamp);
  EXPECT_EQ(map.channel, Channel::green);
  EXPECT_EQ(material("map_bump -bm 0.25 -s 1 1 7.png").map_bump.height, 0.25f);
  EXPECT_EQ(material("map_bump -bm 0.25 -s 1 1 7.png").map_bump.file, "7.png");
}

TEST(Mtl, WhatIsNotUsedIsListed) {
  const MtlFile file = parse_mtl(
      "Kd 9\nnewmtl a\nKa 1 1 1\nKe 0 0 0\nTf 0 0 0\nPr 0.5\nfoo\nnewmtl b\nKe 1 0 0\nTr 0\nTr 0.5\n"
      "Kd spectral a.rfl\n",
      "a.mtl");
  EXPECT_EQ(file.materials.size(), 2u);
  EXPECT_EQ(file.unread, (std::set<std::string>{"Kd", "Ke", "Pr", "Tr", "foo"}));
}

TEST(Mtl, DamageIsToldWithItsLine) {
  EXPECT_EQ(mtl_error("newmtl a\n\nKd 0.5 x 0\n"), "a.mtl:3: \"x\" is not a number");
  EXPECT_EQ(mtl_error("newmtl a\nKd\n"), "a.mtl:2: Kd needs a number");
  EXPECT_EQ(mtl_error("newmtl a\nKd 1 2\n"), "a.mtl:2: Kd has two numbers; it needs one or three");
  EXPECT_EQ(mtl_error("newmtl a\nKd 1 -2 1\n"), "a.mtl:2: a number of Kd is negative");
  EXPECT_EQ(mtl_error("newmtl a\nKs 1 nan 1\n"), "a.mtl:2: a number of Ks is not finite");
  EXPECT_EQ(mtl_error("newmtl a\nNs 1e99\n"), "a.mtl:2: a number of Ns is not finite");
  EXPECT_EQ(mtl_error("newmtl a\nd 1.5\n"), "a.mtl:2: d 1.5 should be from 0 to 1");
  EXPECT_EQ(mtl_error("newmtl a\nmap_Kd -clamp on\n"), "a.mtl:2: map_Kd needs a file");
}

// Bytes exchanged, and the text cut off, anywhere: an Error or a library.
TEST(Mtl, SurvivesDamage) {
  const std::string text = "newmtl a b\nKd .1 .2 .3\nNs 6\nmap_d -s 2 -imfchan m -bm 1 a.png\nd -halo .5\n";
  int accepted = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    accepted += mtl_error(text.substr(0, at)) == "no error";
    for (const char c : {'\0', '\xff', '-', '9', ' ', '\n', '\\', '#', 'e'}) {
      std::string damaged = text;
      damaged[at] = c;
      mtl_error(damaged);
    }
  }
  EXPECT_GT(accepted, 10);
}

std::string obj(const std::string& name, const std::string& inside = "") {
  return fmt::format("<shape type='obj'><string name='filename' value='{}'/>{}</shape>", name, inside);
}
const Material& material(const Scene& s, size_t shape) { return s.materials[s.shapes[shape].material]; }
size_t faces(const Scene& s, size_t shape) { return s.meshes[s.shapes[shape].mesh].triangles.size(); }

TEST(Library, MakesPartsOfAnObjWithoutBsdf) {
  const Scene s = load_inside(obj("shelf.obj"), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 6u);
  EXPECT_EQ(material(s, 0).kind, MaterialKind::diffuse) << "no highlight: Ns is 0";
  EXPECT_RGB(material(s, 0).reflectance.value, 0.60383, 0.13287, 0.03310, 1e-5);  // encoded as sRGB
  EXPECT_EQ(faces(s, 0), 2u);
  EXPECT_EQ(material(s, 1).kind, MaterialKind::dielectric);
  EXPECT_FLOAT_EQ(material(s, 1).ior, 1.5046f / 1.000277f);
  EXPECT_TRUE(says(s.notes, "usemtl glass: its Ni is not used: glass is bk7"));
  EXPECT_EQ(s.shapes[1].mask, none) << "glass is clear by itself";
  EXPECT_EQ(faces(s, 1), 2u);
  EXPECT_EQ(material(s, 2).kind, MaterialKind::conductor);
  EXPECT_RGB(material(s, 2).specular.value, 1, 1, 1, 0);
  EXPECT_GT(material(s, 2).k.x, 6) << "aluminium";
  EXPECT_TRUE(says(s.notes, "usemtl brass: its Ks is not used: mirrors are of aluminium"));
  EXPECT_EQ(material(s, 3).kind, MaterialKind::phong);
  EXPECT_RGB(material(s, 3).reflectance.value, 0.44799, 0.01002, 0.01002, 1e-5);
  EXPECT_RGB(material(s, 3).specular.value, 0.01002, 0.01002, 0.01002, 1e-5);
  EXPECT_FLOAT_EQ(material(s, 3).exponent.value.x, 60);
  EXPECT_EQ(faces(s, 5), 2u) << "before the first usemtl, and without a material in the library";
  EXPECT_RGB(material(s, 5).reflectance.value, 0.5, 0.5, 0.5, 0);
  EXPECT_TRUE(says(s.notes, "shelf.obj: there is no mtllib \"such.mtl\": its materials are grey"));
  EXPECT_TRUE(says(s.notes, "shelf.obj: no mtllib has the material \"not there\": grey"));
  EXPECT_TRUE(says(s.notes, "shelf.mtl: not used: Ke, Pr, Tr"));
  EXPECT_TRUE(
      std::any_of(s.files.begin(), s.files.end(), [](const std::string& file) { return file.ends_with("shelf.mtl"); }));
}

TEST(Library, PicturesBumpsAndHoles) {
  const Scene s = load_inside(obj("shelf.obj"), {}, "0.6.0");
  const Shape& leaf = s.shapes[4];
  const Material &bump = s.materials[leaf.material], &mask = s.materials[leaf.mask];
  ASSERT_EQ(bump.kind, MaterialKind::bumpmap);
  EXPECT_EQ(bump.map_scale, 0.5f);
  EXPECT_TRUE(s.images[s.textures[bump.map.texture].image].decode[128] == 128 / 255.0f) << "heights are raw";
  ASSERT_EQ(mask.kind, MaterialKind::mask);
  Surface at;
  at.uv = {0.3f, 0.3f};
  EXPECT_EQ(s.textures[mask.weight.texture].channel, Channel::alpha) << "in place of d";
  const Texture& picture = s.textures[s.materials[bump.nested[0]].reflectance.texture];
  EXPECT_EQ(picture.wrap_u, Wrap::clamp);
  // v is turned: 4 v + 0.5 from below is 1 - (4 (1 - v) + 0.5) from above
  const Vec3 place = picture.to_uv * Vec3(0.5f, 0.875f, 1);
  EXPECT_FLOAT_EQ(place.x, 1.25f);
  EXPECT_FLOAT_EQ(place.y, 0);
}

TEST(Library, IsLeftAloneWhereTheSceneSaysMore) {
  const std::string red = "<bsdf type='diffuse'><rgb name='reflectance' value='1 0 0'/></bsdf>";
  EXPECT_EQ(load_inside(obj("shelf.obj")).shapes.size(), 1u) << "not in later versions";
  EXPECT_EQ(load_inside(obj("shelf.obj", red), {}, "0.6.0").shapes.size(), 1u);
  EXPECT_EQ(load_inside(obj("shelf.obj", "<boolean name='loadMaterials' value='false'/>"), {}, "0.6.0").shapes.size(),
            1u);
  EXPECT_EQ(load_inside(obj("shelf.obj", red), {}, "0.6.0").notes.size(), 1u) << "no light";
  // some by name: the rest by the library
  const Scene s = load_inside(
      obj("shelf.obj", "<bsdf name='glass' type='conductor'/><bsdf name='brass' type='plastic'/>"), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 6u);
  EXPECT_EQ(material(s, 0).kind, MaterialKind::conductor);
  EXPECT_EQ(material(s, 1).kind, MaterialKind::plastic);
  EXPECT_RGB(material(s, 2).reflectance.value, 0.60383, 0.13287, 0.03310, 1e-5);
  EXPECT_EQ(material(s, 3).kind, MaterialKind::phong);
}

TEST(Library, OneNamedBsdfLeavesTheRest) {
  const auto named = [&](const std::string& name, const std::string& version) {
    return load_inside(obj("shelf.obj", "<bsdf name='" + name + "' type='plastic'/>"), {}, version);
  };
  const Scene s = named("glass", "0.6.0");
  ASSERT_EQ(s.shapes.size(), 6u);
  EXPECT_EQ(material(s, 0).kind, MaterialKind::plastic);
  EXPECT_EQ(faces(s, 0), 2u);
  EXPECT_RGB(material(s, 1).reflectance.value, 0.60383, 0.13287, 0.03310, 1e-5);
  EXPECT_EQ(named("bsdf", "0.6.0").shapes.size(), 1u) << "no usemtl of this name";
  EXPECT_EQ(named("glass", "3.0.0").shapes.size(), 1u);
  const Scene ref =
      load_inside("<bsdf id='m' type='plastic'/>" + obj("shelf.obj", "<ref name='brass' id='m'/>"), {}, "0.6.0");
  EXPECT_EQ(ref.shapes.size(), 6u);
}

TEST(Library, OneGroupHasItsMaterial) {
  const Scene s = load_inside(obj("shelf.obj", "<integer name='shapeIndex' value='3'/>"), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 1u);
  EXPECT_EQ(material(s, 0).kind, MaterialKind::conductor);
  EXPECT_EQ(faces(s, 0), 1u);
}

// Once that is done, nothing is noticed of what becomes of the file.
TEST(Library, IsParsedOnceForAllShapes) {
  const std::string library = write_file("once.mtl", "newmtl a\nKd 1 1 1\n");
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\ng b\nf 1 2 3\n";
  const std::string path = write_file("once.obj", "mtllib " + library + "\n" + faces);
  const auto group = [&](int i) { return obj(path, fmt::format("<integer name='shapeIndex' value='{}'/>", i)); };
  const Document document =
      read_document("<scene version='0.6.0'>" + group(0) + group(1) + "</scene>", ".", "test.xml", {});
  Loader loader{document};
  load_shape(loader, document.root.children[0], none);
  write_file("once.mtl", "newmtl a\nKd no number\n");
  EXPECT_NO_THROW(load_shape(loader, document.root.children[1], none));
  ASSERT_EQ(loader.scene.shapes.size(), 2u);
  EXPECT_RGB(material(loader.scene, 1).reflectance.value, 1, 1, 1, 0);
}

TEST(Library, TheLastOfANameCounts) {
  const std::string first = write_file("first.mtl", "newmtl a\nKd 1 1 1\nnewmtl b\nKd 1 1 1\n");
  const std::string second = write_file("second.mtl", "newmtl a\nKd 1 1 1\nnewmtl a\nKd 0 1 0\n");
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
  const std::string text = "mtllib " + first + "\nmtllib " + second + "\n" + faces;
  const Scene s = load_inside(obj(write_file("two.obj", text)), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_RGB(material(s, 0).reflectance.value, 0, 1, 0, 0);
  EXPECT_RGB(material(s, 1).reflectance.value, 1, 1, 1, 0);
}

// The defaults are Mitsuba's: without illum no highlight, without Kd black.
TEST(Library, SaysLittle) {
  const std::string library = write_file("few.mtl",
                                         "newmtl a\nKd 0.5 0.5 0.5\nKs 1 1 1\nNs 9\nnewmtl b\nd 0.5\nillum 3\n"
                                         "newmtl c\nmap_Kd C:\\elsewhere\\four.png\n");
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n";
  const Scene s = load_inside(obj(write_file("few.obj", "mtllib " + library + "\n" + faces)), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 3u);
  EXPECT_EQ(material(s, 0).kind, MaterialKind::diffuse);
  EXPECT_RGB(material(s, 0).reflectance.value, 0.21404, 0.21404, 0.21404, 1e-5);
  EXPECT_RGB(material(s, 1).reflectance.value, 0, 0, 0, 0);
  EXPECT_EQ(s.materials[s.shapes[1].mask].weight.value, Rgb(0.5f));
  EXPECT_NE(material(s, 2).reflectance.texture, none) << "by its bare name";
}

TEST(Library, MissingOnesAreNoted) {
  const Scene s = load_inside(obj("painted.obj"), {}, "0.6.0");
  ASSERT_EQ(s.shapes.size(), 1u);
  EXPECT_RGB(material(s, 0).reflectance.value, 0.5, 0.5, 0.5, 0);
  EXPECT_TRUE(says(s.notes, "painted.obj: there is no mtllib \"painted.mtl\": its materials are grey"));
  EXPECT_FALSE(says(load_inside(obj("painted.obj")).notes, "mtllib"));
}

}  // namespace
}  // namespace ajar
