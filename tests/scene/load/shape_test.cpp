// Shapes, groups, instances and what hangs on them.
#include <fmt/format.h>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

std::string shape(const std::string& type, const std::string& inside = "") {
  return fmt::format("<shape type='{}'>{}</shape>", type, inside);
}
std::string file(const std::string& name) { return fmt::format("<string name='filename' value='{}'/>", name); }
const std::string flip = "<boolean name='flipNormals' value='true'/>";
const std::string light = "<emitter type='area'/>";

Vec3 normal(const Mesh& mesh, size_t i = 0) {
  const glm::uvec3& t = mesh.triangles[i];
  return glm::normalize(
      glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

TEST(Shapes, Sphere) {
  Scene s = load_inside(shape("sphere",
                              "<point name='center' x='1' y='2' z='3'/><float name='radius' value='2'/>"
                              "<transform name='to_world'><scale value='2'/><translate x='10'/></transform>"));
  ASSERT_EQ(s.shapes[0].kind, ShapeKind::sphere);
  EXPECT_RGB(Vec3(s.shapes[0].to_world * Vec4(0, 0, 0, 1)), 12, 4, 6, 1e-5);
  EXPECT_RGB(Vec3(s.shapes[0].to_world * Vec4(0, 0, 1, 1)), 12, 4, 10, 1e-5);
  EXPECT_RGB(Vec3(s.shapes[0].to_object * Vec4(12, 4, 10, 1)), 0, 0, 1, 1e-6);
  EXPECT_TRUE(load_inside(shape("sphere", flip)).shapes[0].flip);
  EXPECT_RGB(Vec3(load_inside(shape("sphere", "<point name='center' value='1, 2, 3'/>")).shapes[0].to_world[3]), 1, 2,
             3, 0);
  EXPECT_SAYS(error_of(shape("sphere", "<float name='radius' value='-1'/>")), "-1 should be greater than 0");
  EXPECT_SAYS(error_of(shape("sphere", "<float name='radius' value='0'/>")), "should be greater than 0");
}

// An ellipsoid, which is a mesh, has the sides of a sphere under the same transform.
TEST(Shapes, MirroredEllipsoidsAreTurnedAsSpheresAre) {
  const auto faces_out = [](const std::string& inside, const char* version) {
    const Scene s = load_inside(
        shape("sphere", "<transform name='toWorld'><scale x='-1' z='1.01'/></transform>" + inside), {}, version);
    const Mesh& mesh = s.meshes.at(0);
    const glm::uvec3& t = mesh.triangles[mesh.triangles.size() / 2];
    const bool out = glm::dot(normal(mesh, mesh.triangles.size() / 2), mesh.positions[t.x]) > 0;
    if (!mesh.normals.empty()) {
      EXPECT_EQ(glm::dot(mesh.normals[t.x], mesh.positions[t.x]) > 0, out);
    }
    return out;
  };
  const std::string flat = "<boolean name='faceNormals' value='true'/>";
  for (const std::string& more : {std::string(), flat}) {
    EXPECT_TRUE(faces_out(more, "0.6.0"));
    EXPECT_FALSE(faces_out(more, "3.0.0"));
    EXPECT_FALSE(faces_out(more + flip, "0.6.0"));
    EXPECT_TRUE(faces_out(more + flip, "3.0.0"));
  }
}

// Mitsuba 0.x scales the radius alone, and keeps the outside of a mirrored sphere.
TEST(Shapes, SpheresOfOldScenes) {
  const std::string moved = shape("sphere",
                                  "<point name='center' x='1' y='2' z='3'/><transform name='toWorld'>"
                                  "<scale value='2'/><rotate z='1' angle='90'/><translate x='10'/></transform>");
  const Scene old = load_inside(moved, {}, "0.6.0"), now = load_inside(moved);
  EXPECT_RGB(Vec3(old.shapes[0].to_world[3]), 8, 1, 3, 1e-5);
  EXPECT_RGB(Vec3(now.shapes[0].to_world[3]), 6, 2, 6, 1e-5);
  EXPECT_NEAR(glm::length(Vec3(old.shapes[0].to_world[0])), 2, 1e-6);
  const std::string mirror = "<transform name='toWorld'><scale x='-1'/></transform>";
  EXPECT_FALSE(load_inside(shape("sphere", mirror), {}, "0.6.0").shapes[0].flip);
  EXPECT_TRUE(load_inside(shape("sphere", mirror)).shapes[0].flip);
  EXPECT_FALSE(load_inside(shape("sphere", mirror + flip)).shapes[0].flip);
  for (const char* version : {"0.6.0", "3.0.0"})
    EXPECT_TRUE(load_inside(shape("cylinder", mirror), {}, version).shapes[0].flip) << version;
}

// A turn that was written with three decimals.
TEST(Shapes, SpheresOfRoundedMatricesStayRound) {
  const Scene s = load_inside(shape("sphere",
                                    "<transform name='to_world'><matrix value='1.414 0 1.414 0 0 2 0 0 -1.414 "
                                    "0 1.414 2 0 0 0 1'/></transform>"));
  ASSERT_EQ(s.shapes[0].kind, ShapeKind::sphere);
  const Mat4& m = s.shapes[0].to_world;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(glm::length(Vec3(m[i])), 2, 1e-3);
    EXPECT_NEAR(glm::length(Vec3(m[i])), glm::length(Vec3(m[0])), 1e-6);
    EXPECT_NEAR(glm::dot(Vec3(m[i]), Vec3(m[(i + 1) % 3])), 0, 1e-6);
  }
  EXPECT_GT(m[0].x, 1.4f);
  EXPECT_EQ(m[3].z, 2);
}

TEST(Shapes, StretchedSphereBecomesAMesh) {
  const Scene s = load_inside(shape("sphere", "<transform name='to_world'><scale x='2'/></transform>"));
  EXPECT_EQ(s.shapes[0].kind, ShapeKind::mesh);
  EXPECT_TRUE(says(s.notes, "ellipsoid"));
  for (const Vec3& p : s.meshes[0].positions) EXPECT_NEAR(p.x * p.x / 4 + p.y * p.y + p.z * p.z, 1, 1e-5);
}

TEST(Shapes, RectangleAndCube) {
  Scene s = load_inside(shape("rectangle"));
  EXPECT_EQ(s.meshes[0].triangles.size(), 2u);
  EXPECT_RGB(normal(s.meshes[0]), 0, 0, 1, 1e-6);
  EXPECT_RGB(normal(load_inside(shape("rectangle", flip)).meshes[0]), 0, 0, -1, 1e-6);
  EXPECT_EQ(load_inside(shape("cube")).meshes[0].triangles.size(), 12u);
  for (const char* type : {"Rectangle", "recTangle"})
    EXPECT_EQ(load_inside(shape(type)).meshes[0].triangles.size(), 2u);
}

TEST(Shapes, DiskAndCylinder) {
  Scene s = load_inside(shape("disk", "<transform name='toWorld'><scale value='3'/></transform>"));
  EXPECT_EQ(s.shapes[0].kind, ShapeKind::disk);
  EXPECT_FLOAT_EQ(s.shapes[0].to_world[0][0], 3);
  s = load_inside(
      shape("cylinder", "<point name='p0' x='1'/><point name='p1' x='1' y='4'/><float name='radius' value='0.5'/>"));
  const Mat4 m = s.shapes[0].to_world;
  EXPECT_EQ(s.shapes[0].kind, ShapeKind::cylinder);
  EXPECT_RGB(Vec3(m * Vec4(0, 0, 0, 1)), 1, 0, 0, 1e-6);
  EXPECT_RGB(Vec3(m * Vec4(0, 0, 1, 1)), 1, 4, 0, 1e-6);
  EXPECT_NEAR(glm::length(Vec3(m[0])), 0.5, 1e-6);
  EXPECT_NEAR(glm::dot(Vec3(m[0]), Vec3(m[2])), 0, 1e-6);
  EXPECT_GT(glm::determinant(m), 0);
  for (const char* version : {"0.6.0", "3.0.0"}) {
    s = load_inside(shape("cylinder"), {}, version);
    EXPECT_RGB(Vec3(s.shapes[0].to_world * Vec4(0, 0, 1, 1)), 0, 0, 1, 1e-6);
    EXPECT_RGB(Vec3(s.shapes[0].to_world[0]), 1, 0, 0, 0);  // where u begins
  }
  EXPECT_SAYS(error_of(shape("cylinder", "<point name='p0' z='1'/>")), "the same point");
  const auto is_noted = [](const std::string& scale) {
    const std::string to_world = fmt::format("<transform name='to_world'><scale {}/></transform>", scale);
    return says(load_inside(shape("cylinder", to_world)).notes, "it is not round");
  };
  EXPECT_TRUE(is_noted("x='1.2' y='.4'"));
  EXPECT_FALSE(is_noted("x='2' y='2' z='7'"));
}

TEST(Shapes, MeshFiles) {
  Scene s =
      load_inside(shape("obj", file("two words.obj") + "<transform name='to_world'><translate x='5'/></transform>"));
  EXPECT_EQ(s.meshes[0].triangles.size(), 1u);
  EXPECT_FLOAT_EQ(s.meshes[0].positions[1].x, 6);
  EXPECT_EQ(load_inside(shape("obj", file("folder\\inner.obj"))).meshes.size(), 1u);
  EXPECT_TRUE(load_inside(shape("obj", file("two words.obj") + "<boolean name='faceNormals' value='true'/>"))
                  .meshes[0]
                  .normals.empty());
  s = load_inside(shape("ply", file("coloured.ply") + flip));
  EXPECT_RGB(normal(s.meshes[0]), 0, 0, -1, 1e-6);
  s = load_inside(shape("obj", file("empty.obj")));
  EXPECT_TRUE(s.shapes.empty());
  EXPECT_TRUE(says(s.notes, "empty.obj has no faces: left out"));
  EXPECT_SAYS(error_of(fmt::format("\n{}", shape("obj"))),
              "test.xml:3: <shape type=\"obj\">: needs <string name=\"filename\"");
  EXPECT_SAYS(error_of(shape("ply", file("two words.obj"))), "test.xml:2: <shape type=\"ply\">: ");
  EXPECT_SAYS(error_of(shape("serialized", file("two words.obj") + "<integer name='shapeIndex' value='-1'/>")),
              "whole number");
}

TEST(Shapes, OneFileManyPlaces) {
  const auto placed = [](const std::string& steps) {
    return shape("obj", file("two words.obj") + "<transform name='to_world'>" + steps + "</transform>");
  };
  const Scene s = load_inside(placed("") + placed("<translate x='1'/>") + placed("<scale x='2'/>") +
                              placed("<scale x='-1'/>") + placed("<scale value='3'/>"));
  ASSERT_EQ(s.meshes.size(), 5u);
  const float ends[] = {1, 2, 2, -1, 3};
  for (size_t i = 0; i < 5; ++i) EXPECT_FLOAT_EQ(s.meshes[i].positions[1].x, ends[i]);
}

TEST(Shapes, Materials) {
  Scene s = load_inside(shape("sphere") + shape("sphere") + shape("sphere", light));
  EXPECT_EQ(s.shapes[0].material, s.shapes[1].material);
  EXPECT_FLOAT_EQ(s.materials[s.shapes[0].material].reflectance.value.x, 0.5f);
  EXPECT_FLOAT_EQ(s.materials[s.shapes[2].material].reflectance.value.x, 0);  // as in Mitsuba
  s = load_inside(shape("sphere", "<bsdf name='bsdf' type='null'/>"));
  EXPECT_EQ(s.materials[s.shapes[0].material].kind, MaterialKind::null);
  EXPECT_SAYS(error_of(shape("sphere", "<bsdf type='null'/><bsdf type='null'/>")), "more than one bsdf");
  s = load_inside(shape("sphere", "<bsdf type='null'/><bsdf type='plastic'/>"), {}, "0.6.0");
  EXPECT_EQ(s.materials[s.shapes[0].material].kind, MaterialKind::plastic);
  EXPECT_TRUE(says(s.notes, "has more than one bsdf: the last one counts"));
  s = load_inside(shape("obj", file("halves.obj") + "<bsdf type='null'/><bsdf type='plastic'/>"), {}, "0.6.0");
  EXPECT_EQ(s.materials[s.shapes.at(0).material].kind, MaterialKind::plastic);
}

// halves.obj: two triangles of usemtl "Left One" at x < 0, one of "right" at x > 0.
TEST(Shapes, BsdfsOfAnObjGoByUsemtl) {
  const auto named = [](const std::string& name, double grey) {
    return fmt::format("<bsdf name='{}' type='diffuse'><rgb name='reflectance' value='{}'/></bsdf>", name, grey);
  };
  const auto grey = [](const Scene& s, size_t i) { return s.materials[s.shapes[i].material].reflectance.value.x; };
  const std::string halves = file("halves.obj");
  Scene s = load_inside(shape("obj", halves + named("right", 0.2) + named("Left One", 0.7) + light));
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(s.meshes[s.shapes[0].mesh].triangles.size(), 1u);
  EXPECT_FLOAT_EQ(grey(s, 0), 0.2f);
  EXPECT_GT(s.meshes[s.shapes[0].mesh].positions[1].x, 0);
  EXPECT_EQ(s.meshes[s.shapes[1].mesh].triangles.size(), 2u);
  EXPECT_FLOAT_EQ(grey(s, 1), 0.7f);
  EXPECT_LT(s.meshes[s.shapes[1].mesh].positions[1].x, 0);
  EXPECT_EQ(s.lights.size(), 2u);
  EXPECT_EQ(s.lights[s.shapes[1].light].shape, 1u);
  // the rest: the one without a name, or the default
  s = load_inside(shape("obj", halves + named("right", 0.2) + "<bsdf type='null'/>"));
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(s.materials[s.shapes[1].material].kind, MaterialKind::null);
  s = load_inside("<bsdf type='plastic' id='m'/>" +
                  shape("obj", halves + named("nowhere", 0.2) + "<ref name='right' id='m'/>"));
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(s.materials[s.shapes[0].material].kind, MaterialKind::plastic);
  EXPECT_FLOAT_EQ(grey(s, 1), 0.5f);
  EXPECT_EQ(s.meshes[s.shapes[1].mesh].triangles.size(), 2u);
  EXPECT_TRUE(says(s.notes, "halves.obj has no faces of usemtl nowhere"));
  // one alone is for all faces
  s = load_inside(shape("obj", halves + named("right", 0.2)));
  ASSERT_EQ(s.shapes.size(), 1u);
  EXPECT_EQ(s.meshes[0].triangles.size(), 3u);
  EXPECT_SAYS(error_of(shape("obj", halves + "<bsdf type='null'/><bsdf type='null'/>")), "second bsdf without a name");
  EXPECT_SAYS(error_of(shape("obj", halves + named("a", 0.1) + named("a", 0.2))), "has the name of another bsdf");
}

// A floor and a wall with a common edge, in two groups.
const std::string corner = "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 1 0\nv 0 1 1\ng a\nf 1 2 3 4\ng b\nf 1 5 6 2\n";

TEST(Shapes, GroupsOfAnOldObjAreMeshesOfTheirOwn) {
  const std::string file = "<string name='filename' value='" + write_file("corner.obj", corner) + "'/>";
  const auto mesh = [&](const std::string& version, const std::string& inside = "") {
    return load_inside("<shape type='obj'>" + file + inside + "</shape>", {}, version).meshes.at(0);
  };
  EXPECT_EQ(mesh("3.0.0").positions.size(), 6u);
  EXPECT_EQ(mesh("0.6.0").positions.size(), 8u);
  EXPECT_EQ(mesh("0.6.0").normals[0], Vec3(0, 1, 0));
  EXPECT_EQ(mesh("0.6.0", "<boolean name='collapse' value='true'/>").positions.size(), 6u);
  const std::string second = "<integer name='shapeIndex' value='1'/>";
  EXPECT_EQ(mesh("0.6.0", second).positions.size(), 4u);
  EXPECT_EQ(mesh("0.6.0", second).positions[1], Vec3(0, 1, 0));
  EXPECT_TRUE(says(load_inside("<shape type='obj'>" + file + second + "</shape>").notes, "\"shapeIndex\" is not used"));
  EXPECT_SAYS(kit::error_of([&] { mesh("0.6.0", "<integer name='shapeIndex' value='2'/>"); }),
              "corner.obj: shapeIndex 2: the file has 2 groups of faces, counted from 0");
  // both of one file, and all of it
  const auto part = [&](const std::string& inside) { return "<shape type='obj'>" + file + inside + "</shape>"; };
  const Scene s =
      load_inside(part(second) + part("<integer name='shapeIndex' value='0'/>") + part(second) + part(""), {}, "0.6.0");
  ASSERT_EQ(s.meshes.size(), 4u);
  EXPECT_EQ(s.meshes[1].positions[1], Vec3(0, 0, 1));
  EXPECT_EQ(s.meshes[2].positions[1], Vec3(0, 1, 0));
  EXPECT_EQ(s.meshes[3].triangles.size(), 4u);
}

// In version 0.x colours of vertices are encoded as sRGB unless the scene says otherwise.
TEST(Shapes, ColoursOfPlys) {
  for (const std::string& prefix : {std::string(), std::string("diffuse_")}) {
    const std::string property = "property uchar " + prefix;
    const std::string path = write_file(prefix + "grey.ply",
                                        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                        "property float z\n" +
                                            property + "red\n" + property + "green\n" + property +
                                            "blue\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                            "0 0 0 128 255 0\n1 0 0 128 255 0\n0 1 0 128 255 0\n3 0 1 2\n");
    const std::string encoded = shape("ply", file(path));
    const std::string linear = shape("ply", file(path) + "<boolean name='srgb' value='false'/>");
    const Scene old = load_inside(encoded + linear + encoded + linear, {}, "0.6.0");
    for (size_t i = 0; i < 4; ++i)
      EXPECT_RGB(old.meshes[i].colors.at(1), i % 2 == 0 ? 0.21586 : 128 / 255.0, 1, 0, 1e-5);
    EXPECT_FALSE(says(old.notes, "srgb"));
    EXPECT_RGB(load_inside(encoded).meshes[0].colors.at(1), 0.21586, 1, 0, 1e-5);  // integers, in later ones
    EXPECT_TRUE(says(load_inside(linear).notes, "\"srgb\" is not used"));
  }
}

TEST(Shapes, StraysAreTold) {
  const std::string texture = "<texture type='checkerboard' id='t'/>";
  EXPECT_TRUE(says(load_inside(texture + shape("sphere", "<ref id='t'/>")).notes,
                   "<ref id=\"t\">: a texture is no bsdf: not used; put it inside one"));
  const std::string group = "<shape type='shapegroup' id='g'><shape type='sphere'/></shape>";
  const Scene s = load_inside(group + shape("instance", "<ref id='g'/><bsdf type='plastic'/><emitter type='area'/>"));
  EXPECT_TRUE(says(s.notes, "<bsdf type=\"plastic\">: an instance shows its shapegroup as it is: not used"));
  EXPECT_TRUE(says(s.notes, "<emitter type=\"area\">: an instance shows its shapegroup as it is: not used"));
}

TEST(Shapes, Emitters) {
  const Scene s = load_inside(shape("cube") + shape("sphere", light));
  ASSERT_EQ(s.lights.size(), 1u);
  EXPECT_EQ(s.shapes[1].light, 0u);
  EXPECT_EQ(s.lights[0].shape, 1u);
  EXPECT_EQ(s.shapes[0].light, none);
  EXPECT_SAYS(error_of(shape("sphere", light + light)), "more than one emitter");
  EXPECT_SAYS(error_of(shape("sphere", "<emitter type='point'/>")), "only an area light");
}

TEST(Shapes, GroupsAndInstances) {
  const std::string group = fmt::format("<shape type='shapegroup' id='g'>{}{}</shape>", shape("cube"), shape("sphere"));
  const auto instance = [](const std::string& steps) {
    return shape("instance", "<ref id='g'/><transform name='toWorld'>" + steps + "</transform>");
  };
  for (const std::string& text :
       {group + instance("<scale x='-1'/>") + instance(""), instance("<scale x='-1'/>") + instance("") + group}) {
    const Scene s = load_inside(text);
    EXPECT_EQ(s.groups, 1u);
    EXPECT_EQ(s.shapes.size(), 2u);
    EXPECT_EQ(s.shapes[0].group, 0u);
    ASSERT_EQ(s.instances.size(), 2u);
    EXPECT_FLOAT_EQ(s.instances[0].to_world[0][0], -1);
    EXPECT_FLOAT_EQ(s.instances[0].to_object[0][0], -1);
  }
  EXPECT_SAYS(error_of(shape("instance")), "needs a <ref> to one <shape type=\"shapegroup\">");
  EXPECT_SAYS(error_of(group + instance("<scale value='0'/>")), "singular");
  const std::string lit = shape("shapegroup", shape("sphere", light));
  EXPECT_SAYS(error_of(lit), "light inside a shapegroup");
  const Scene dark = load_inside(lit, lenient());
  EXPECT_EQ(dark.shapes.size(), 1u);
  EXPECT_TRUE(dark.lights.empty());
}

TEST(Shapes, WhatShowsNothingIsTold) {
  EXPECT_TRUE(says(load_inside("<shape type='shapegroup'/>").notes, "holds no shapes: nothing is seen of it"));
  const std::string flat = "<transform name='to_world'><scale value='1e-30'/></transform>";
  EXPECT_TRUE(says(load_inside("<shape type='rectangle'>" + flat + "<emitter type='area'/></shape>").notes,
                   "its faces have no area: it emits nothing"));
  EXPECT_FALSE(says(load_inside("<shape type='rectangle'><emitter type='area'/></shape>").notes, "no area"));
  EXPECT_FALSE(says(load_inside("<shape type='sphere'><emitter type='area'/></shape>").notes, "no area"));
}

TEST(Shapes, Merge) {
  const Scene s = load_inside(shape("merge", shape("cube") + shape("sphere")));
  EXPECT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(s.shapes[0].group, none);
}

TEST(Shapes, MediaAreRefused) {
  const std::string inner = shape("cube", "<medium name='interior' type='homogeneous'/>");
  EXPECT_SAYS(error_of(inner), "participating media are not supported");
  EXPECT_TRUE(says(load_inside(inner, lenient()).notes, "participating media are not supported"));
  EXPECT_EQ(load_inside(inner, lenient()).shapes.size(), 1u);
  const std::string named = "<medium type='homogeneous' id='m'/>";
  EXPECT_SAYS(error_of(named + shape("cube", "<ref name='exterior' id='m'/>")), "participating media");
  EXPECT_TRUE(says(load_inside(named + shape("cube")).notes, "participating media"));
}

// In 0.x what only bounds a medium is not seen; later versions see a diffuse surface.
TEST(Shapes, BoundsOfMedia) {
  const auto kind = [](const std::string& inner, const char* version) {
    const Scene s = load_inside(shape("cube", inner), lenient(), version);
    return s.materials[s.shapes[0].material].kind;
  };
  const std::string medium = "<medium name='interior' type='homogeneous'/>";
  EXPECT_EQ(kind(medium, "0.5.0"), MaterialKind::null);
  EXPECT_EQ(kind(medium, "3.0.0"), MaterialKind::diffuse);
  EXPECT_EQ(kind("", "0.5.0"), MaterialKind::diffuse);
  EXPECT_EQ(kind(medium + "<bsdf type='conductor'/>", "0.5.0"), MaterialKind::conductor);
}

TEST(Shapes, UnknownOnes) {
  for (const char* type : {"hair", "bsplinecurve", "sdfgrid", "heightfield"}) {
    EXPECT_SAYS(error_of(shape(type)), "unknown shape; supported: obj, ply, serialized, rectangle");
    EXPECT_TRUE(load_inside(shape(type), lenient()).shapes.empty());
  }
}

// Hints for derivatives that change no picture.
TEST(Shapes, HintsForDerivativesAreNoStrays) {
  const std::string hint = "<float name='silhouette_sampling_weight' value='0.5'/>";
  EXPECT_FALSE(says(load_inside("<shape type='sphere'>" + hint + "</shape>").notes, "silhouette"));
}

TEST(Shapes, FarAwayIsAnError) {
  const std::string move = "<transform name='to_world'><translate x='1e30'/></transform>";
  EXPECT_SAYS(error_of(shape("sphere", "") + shape("sphere", "<point name='center' x='1e30'/>")),
              "test.xml: scene: the shape \"sphere:2\" reaches farther than 1e+18 units");
  EXPECT_SAYS(error_of(shape("sphere", "") + "<shape type='cube' id='great'>" + move + "</shape>"),
              "scene: the shape \"great\" reaches farther");
  EXPECT_SAYS(error_of("<shape type='shapegroup' id='g'>" + shape("cube", "") + "</shape>" +
                       shape("instance", "<ref id='g'/>" + move)),
              "scene: instance 0 reaches farther");
  EXPECT_NE(error_of(shape("sphere", "<point name='center' x='3e38'/>")), "");
  EXPECT_NE(
      error_of(shape("cube", "<transform name='to_world'><scale value='3e38'/><translate x='3e38'/></transform>")), "");
}

TEST(Shapes, TextureCoordinatesOfCornersAreNoted) {
  const auto notes = [](const std::string& list, const std::string& numbers) {
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
    const std::string faces = "property float z\nelement face 1\nproperty list uchar int vertex_indices\n";
    const std::string path =
        write_file("corners.ply", head + faces + list + "end_header\n0 0 0 1 0 0 0 1 0\n3 0 1 2" + numbers + "\n");
    return load_inside("<shape type='ply'><string name='filename' value='" + path + "'/></shape>").notes;
  };
  const std::string words = "(the list texcoord) are not used; write them as u and v of the vertices";
  EXPECT_TRUE(says(notes("property list uchar float texcoord\n", " 6 0 0 1 0 0 1"), words));
  EXPECT_FALSE(says(notes("property list uchar float other\n", " 1 0"), "texcoord"));
}

}  // namespace
}  // namespace ajar
