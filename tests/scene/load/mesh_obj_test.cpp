#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "kit/files.h"
#include "mesh_samples.h"
#include "scene/load/obj.h"

namespace ajar {
namespace {

Mesh obj(const std::string& text, const MeshOptions& options = {.face_normals = true}) {
  Mesh mesh = parse_obj(text, "a.obj", options);
  EXPECT_EQ(kit::unsound(mesh), "");
  return mesh;
}

std::string obj_error(const std::string& text) {
  try {
    parse_obj(text, "a.obj", {});
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "no error";
}

const std::string three_vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(MeshObj, reads_a_triangle_with_everything) {
  const Mesh m =
      obj("v 0 0 0\nv 2 0 0\nv 0 3 0\nvt 0 0\nvt 1 0 5\nvt 0 1\nvn 0 0 4\nf 1/1/1 2/2/1 3/3/1\n", MeshOptions());
  ASSERT_EQ(m.triangles.size(), 1u);
  EXPECT_EQ(m.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(m.positions[2], Vec3(0, 3, 0));
  EXPECT_EQ(m.uvs[1], Vec2(1, 0));
  EXPECT_EQ(m.normals[1], Vec3(0, 0, 1));
}

TEST(MeshObj, shares_vertices_with_equal_corners_only) {
  const Mesh m = obj(three_vertices + "v 1 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 2/1 4/1 3/2\n");
  EXPECT_EQ(m.positions.size(), 5u);  // v3 with vt1 and with vt2
  EXPECT_EQ(m.triangles[1].x, m.triangles[0].y);
  EXPECT_NE(m.triangles[1].z, m.triangles[0].z);
}

TEST(MeshObj, many_distinct_corners_at_one_position) {
  std::string text = three_vertices;
  for (int i = 0; i < 20000; ++i) text += "vt 0." + std::to_string(i) + " 0\nf 1/-1 2/1 3/1\n";
  EXPECT_EQ(obj(text).positions.size(), 20002u);
}

TEST(MeshObj, reads_numbers_in_every_spelling) {
  const Mesh m = obj("v 1e-007 +2 -.5\nv 1.E+1 1e-400 -0\nv 3.4e38 00012 1e0\nf 1 2 3");
  EXPECT_EQ(m.positions[0], Vec3(1e-7f, 2, -0.5f));
  EXPECT_EQ(m.positions[1], Vec3(10, 0, 0));
  EXPECT_EQ(m.positions[2], Vec3(3.4e38f, 12, 1));
}

TEST(MeshObj, blanks_comments_line_ends_and_continuations) {
  const Mesh m = obj(
      "\xef\xbb\xbf# comment \\\r\n\r\n  v\t0 0 0  \r\nv 1 0 0# tail\r\nv 0 \\\r\n  1 \\ \r\n 0\r\n\tf 1 2\\\n 3 \r\n");
  ASSERT_EQ(m.triangles.size(), 1u);
  EXPECT_EQ(m.positions[2], Vec3(0, 1, 0));
  EXPECT_EQ(obj("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").triangles.size(), 1u);  // CR alone
}

TEST(MeshObj, passes_over_what_is_not_geometry) {
  const Mesh m = obj("mtllib a b.mtl\no name\ng a b\ns 1\nusemtl x\nvp 1 2\nl 1 2\np 1\nfoo\n" + three_vertices +
                     "g\ns off\nf 1 2 3\n");
  EXPECT_EQ(m.triangles.size(), 1u);
}

TEST(MeshObj, negative_indices_count_back_from_where_they_stand) {
  const Mesh m = obj(three_vertices + "f -3 -2 -1\nv 5 5 5\nv 6 6 6\nv 7 7 8\nf -3 -2 -1\n");
  EXPECT_EQ(m.positions[m.triangles[0].x], Vec3(0, 0, 0));
  EXPECT_EQ(m.positions[m.triangles[1].x], Vec3(5, 5, 5));
}

TEST(MeshObj, indices_may_run_ahead) { EXPECT_EQ(obj("f 1 2 3\n" + three_vertices).positions[1], Vec3(1, 0, 0)); }

TEST(MeshObj, corners_without_vt_or_vn) {
  const Mesh m = obj(three_vertices + "vt 0.5 0.25\nvn 0 0 1\nf 1/1/1 2//1 3/1\nf 1 2/ 3/1/\n", MeshOptions());
  EXPECT_EQ(m.uvs[m.triangles[0].x], Vec2(0.5f, 0.25f));
  EXPECT_EQ(m.uvs[m.triangles[0].y], Vec2(0, 0));
  for (const Vec3& n : m.normals) EXPECT_EQ(n, Vec3(0, 0, 1));
}

TEST(MeshObj, polygons_become_triangles) {
  const Mesh m = obj("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nf 1 2 3 4 5\n");
  ASSERT_EQ(m.triangles.size(), 3u);
  double area = 0;
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(kit::face_normal(m, i), Vec3(0, 0, 1));
    const glm::uvec3 t = m.triangles[i];
    area += 0.5 * glm::length(glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]));
  }
  EXPECT_DOUBLE_EQ(area, 5);
}

TEST(MeshObj, concave_quads_are_cut_inside) {
  for (const char* face : {"f 1 2 3 4", "f 2 3 4 1", "f 3 4 1 2", "f 4 1 2 3"}) {
    const Mesh m = obj(std::string("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\n") + face);  // reflex at v3
    ASSERT_EQ(m.triangles.size(), 2u);
    EXPECT_EQ(kit::face_normal(m, 0), Vec3(0, 0, 1)) << face;
    EXPECT_EQ(kit::face_normal(m, 1), Vec3(0, 0, 1)) << face;
  }
}

// Two notches: an E of twelve corners, whose fans from most corners lie outside of it.
TEST(MeshObj, concave_polygons_are_cut_inside) {
  const char* const corners[] = {"0 0", "3 0", "3 1", "1 1", "1 2", "3 2", "3 3", "1 3", "1 4", "3 4", "3 5", "0 5"};
  std::string text;
  for (const char* at : corners) text += fmt::format("v {} 0\n", at);
  for (size_t first = 0; first < 12; ++first) {
    std::string face = "f";
    for (size_t i = 0; i < 12; ++i) face += fmt::format(" {}", (first + i) % 12 + 1);
    const Mesh m = obj(text + face + "\n");
    ASSERT_EQ(m.triangles.size(), 10u);
    double area = 0;
    for (size_t i = 0; i < 10; ++i) {
      const glm::uvec3 t = m.triangles[i];
      const Vec3 cross = glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]);
      EXPECT_GE(cross.z, 0) << first;
      area += 0.5 * double(glm::length(cross));
      const Vec3 middle = (m.positions[t.x] + m.positions[t.y] + m.positions[t.z]) / 3.0f;
      EXPECT_FALSE(middle.x > 1 && ((middle.y > 1 && middle.y < 2) || (middle.y > 3 && middle.y < 4))) << first;
    }
    EXPECT_DOUBLE_EQ(area, 11) << first;
  }
}

TEST(MeshObj, faces_without_area) {
  EXPECT_EQ(obj(three_vertices + "f 1 2\nf 1\nf\n").triangles.size(), 0u);
  const Mesh m = obj(three_vertices + "f 1 1 2\nf 1 2 2 1\n", MeshOptions());  // stay, with normals that are unit
  EXPECT_EQ(m.triangles.size(), 3u);
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
}

TEST(MeshObj, colours) {
  const Mesh m = obj("v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 0 1 0 1 0 0 1\nv 0 0 1 0.7\nf 1 2 3\nf 1 2 4");
  ASSERT_EQ(m.colors.size(), 4u);
  EXPECT_EQ(m.colors[0], Rgb(1));
  EXPECT_EQ(m.colors[1], Rgb(0.5f, 0.25f, 1));
  EXPECT_EQ(m.colors[2], Rgb(0, 0, 1));  // x y z w r g b
  EXPECT_TRUE(obj(three_vertices + "f 1 2 3").colors.empty());
}

TEST(MeshObj, flip_v) {
  const std::string text = three_vertices + "vt 0.25 0.25\nf 1/1 2/1 3/1\n";
  EXPECT_EQ(obj(text).uvs[0], Vec2(0.25f, 0.25f));
  EXPECT_EQ(obj(text, {.flip_v = true}).uvs[0], Vec2(0.25f, 0.75f));
}

TEST(MeshObj, normals_of_the_file) {
  const std::string text =
      three_vertices + "vn 0 3 4\nvn 0 0 0\nvn nan 0 1\nvn 1e200 0 1e200\nf 1//1 2//2 3//3\nf 1//4 2//2 3//3";
  const Mesh m = obj(text, MeshOptions());
  EXPECT_EQ(m.normals[0], Vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(m.normals[1], Vec3(0, 0, 1));  // zero: that of the faces
  EXPECT_EQ(m.normals[2], Vec3(0, 0, 1));  // not a number
  EXPECT_NEAR(m.normals[3].x, std::sqrt(0.5f), 1e-6f);
  EXPECT_TRUE(obj(text).normals.empty());  // face_normals
}

// As Microsoft's libraries wrote them; elsewhere a # begins a comment.
TEST(MeshObj, numbers_that_are_none_have_more_spellings) {
  const std::string normals = "vn -1.#IND00 1.#QNAN 0\nvn 1.#INF 0 0\nvn 0 1 0#IND\nf 1//1 2//2 3//3";
  const Mesh m = obj(three_vertices + normals, MeshOptions());
  EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[1], Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[2], Vec3(0, 1, 0));
}

// A floor and a wall with a common edge, the z axis.
const std::string open_corner = "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 1 0\nv 0 1 1\n%f 1 2 3 4\n%f 1 5 6 2\n";
std::string cornered(const std::string& first, const std::string& second) {
  std::string text = open_corner;
  text.replace(text.find('%'), 1, first);
  return text.replace(text.find('%'), 1, second);
}
// Whether computed normals are smooth across the edge.
bool smooth(const std::string& text, const MeshOptions& options) {
  const Mesh m = obj(text, options);
  EXPECT_EQ(m.triangles.size(), 4u);
  const Vec3 floor = m.normals[m.triangles[0].x], wall = m.normals[m.triangles[2].x];
  EXPECT_EQ(m.positions[m.triangles[0].x], Vec3(0));
  EXPECT_EQ(m.positions[m.triangles[2].x], Vec3(0));
  return floor == wall;
}

TEST(MeshObj, groups_share_computed_normals_or_not) {
  const MeshOptions together, apart{.weld = true, .apart = true};
  const std::string grouped = cornered("g a\n", "g b\n"), used = cornered("", "usemtl b\n");
  for (const std::string& text : {grouped, used}) {
    EXPECT_TRUE(smooth(text, together));
    EXPECT_FALSE(smooth(text, apart));
    EXPECT_FALSE(smooth(text, {.max_smooth_angle = 120, .apart = true}));
    EXPECT_TRUE(smooth(text, {.max_smooth_angle = 120}));
  }
  EXPECT_TRUE(smooth(cornered("g a\n", ""), apart));
  EXPECT_EQ(obj(grouped, apart).positions.size(), 8u);
  // where one has uv and the other none
  const Mesh m = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1 2 3\ng b\nf 1/1 2/1 3/1\n", apart);
  EXPECT_EQ(m.uvs, (std::vector<Vec2>{Vec2(0), Vec2(0), Vec2(0), Vec2(1), Vec2(1), Vec2(1)}));
}

TEST(MeshObj, one_group_alone) {
  const std::string text = cornered("g nothing yet\ng a\n", "usemtl b\ng c\n");
  EXPECT_EQ(obj(text, {.group = 1}).positions[1], Vec3(0, 1, 0));
  EXPECT_EQ(obj(text, {.group = 1}).triangles.size(), 2u);
  EXPECT_EQ(obj(text, {.group = 0}).positions[3], Vec3(1, 0, 0));
  EXPECT_EQ(kit::error_of([&] { parse_obj(text, "a.obj", {.group = 2}); }),
            "a.obj: shapeIndex 2: the file has 2 groups of faces, counted from 0");
}

// Each part is made of its own runs of faces, and of no others.
TEST(MeshObj, parts_are_made_of_runs_of_faces) {
  std::string text = "vn 0 0 1\n";
  for (int k = 0; k < 7; ++k) text += fmt::format("v {0} 0 0\nv {0} 1 0\nv {0} 0 1\n", k);
  int i = 0;
  for (const char* line : {"", "usemtl a\n", "g again\nusemtl a\n", "usemtl b\n", "usemtl a\n", "", "usemtl b\n"})
    text += fmt::format("{}f {}//1 {}//1 {}//1\n", line, i + 1, i + 2, i + 3), i += 3;
  const ObjFile file = scan_obj(text, "a.obj");
  using Runs = std::vector<FaceRange>;
  EXPECT_EQ(file.runs, (std::vector<Runs>{{{0, 1}}, {{1, 3}, {4, 6}}, {{3, 4}, {6, 7}}}));
  EXPECT_FALSE(file.lacks_normals);
  const auto places = [&](const MeshOptions& options) {
    std::string out;
    const Mesh m = join(file, options);
    for (const glm::uvec3& t : m.triangles) out += std::to_string(int(m.positions[t.x].x));
    return out;
  };
  for (const bool apart : {false, true}) {  // where normals are made anew, group by group
    const float angle = apart ? 10.0f : -1.0f;
    EXPECT_EQ(places({.max_smooth_angle = angle, .apart = apart}), "0123456");
    EXPECT_EQ(places({.max_smooth_angle = angle, .material = "a", .apart = apart}), "1245");
    EXPECT_EQ(places({.max_smooth_angle = angle, .material = "b", .apart = apart}), "36");
    EXPECT_EQ(places({.max_smooth_angle = angle, .without = {"a"}, .apart = apart}), "036");
    EXPECT_EQ(places({.max_smooth_angle = angle, .without = {"a", "b"}, .apart = apart}), "0");
    EXPECT_EQ(places({.max_smooth_angle = angle, .material = "c", .apart = apart}), "");
  }
  EXPECT_EQ(places({.material = "a", .group = 2}), "2");
  EXPECT_EQ(places({.material = "a", .group = 3}), "");
  EXPECT_EQ(places({.without = {"b"}, .group = 4}), "45");
  EXPECT_EQ(places({.without = {"b"}, .group = 3}), "");
}

TEST(MeshObj, equal_corners_are_one_or_not) {
  const std::string doubled =
      open_corner.substr(0, open_corner.find('%')) + "v -0 0 0\nv 0 -0 1\nf 1 2 3 4\nf 7 5 6 8\n";
  EXPECT_FALSE(smooth(doubled, {}));
  EXPECT_TRUE(smooth(doubled, {.weld = true}));
  // uv counts, equal normals of the file are as they are
  EXPECT_EQ(
      obj(three_vertices + three_vertices + "vt 0 0\nvt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 4/2 5/3 6/3\n", {.weld = true})
          .positions.size(),
      5u);
  EXPECT_EQ(obj(three_vertices + three_vertices + "vn 0 0 1\nf 1//1 2//1 3//1\nf 4//1 5//1 6//1\n", {.weld = true})
                .positions.size(),
            6u);
}

TEST(MeshObj, empty_files_are_empty_meshes) {
  EXPECT_TRUE(obj("").triangles.empty());
  EXPECT_TRUE(obj("# nothing", MeshOptions()).positions.empty());
}

TEST(MeshObj, an_index_0_stands_for_what_a_corner_lacks) {
  for (const char* faces : {"f 1/0/0 2/0/0 3/0/0\n", "f 1/0 2/0 3/0\n", "f 1//0 2//0 3//0\n"}) {
    const Mesh m = obj(three_vertices + faces, MeshOptions());
    EXPECT_EQ(m.triangles.size(), 1u) << faces;
    EXPECT_TRUE(m.uvs.empty()) << faces;
    EXPECT_EQ(m.normals[0], Vec3(0, 0, 1)) << faces;  // the face's
  }
  const Mesh m = obj(three_vertices + "vt .5 .5\nvn 1 0 0\nf 1/0/1 2/1/0 3/0/1\n", MeshOptions());
  EXPECT_EQ(m.uvs[1], Vec2(.5, .5));
  EXPECT_EQ(m.normals[1], Vec3(0, 0, 1));
  EXPECT_EQ(m.normals[2], Vec3(1, 0, 0));
}

// As exporters write what they could not compute.
TEST(MeshObj, texture_coordinates_that_are_not_finite_become_zero) {
  for (const char* bad : {"vt nan nan", "vt 0.5 inf", "vt -nan 0.5", "vt 1e39 1", "vt 1.#QNAN 0"}) {
    const Mesh m = obj(three_vertices + "\nvt 0.5 0.25\n" + bad + "\nf 1/1 2/2 3/1\n");
    EXPECT_EQ(m.uvs[0], Vec2(0.5f, 0.25f)) << bad;
    EXPECT_EQ(m.uvs[1], Vec2(0)) << bad;
  }
}

TEST(MeshObj, errors_name_file_line_and_culprit) {
  EXPECT_EQ(obj_error("v 1 2\n"), "a.obj:1: v has 2 coordinates; it needs x y z");
  EXPECT_EQ(obj_error("\n\nv 1,5 2 3\n"), "a.obj:3: \"1,5\" is not a number");
  EXPECT_EQ(obj_error("v 1 2 \\\n z\n"), "a.obj:2: \"z\" is not a number");
  EXPECT_NE(obj_error("v 0 0 inf").find("a.obj:1: a coordinate of v is not finite"), std::string::npos);
  EXPECT_NE(obj_error("v 0 0 1e39").find("not finite"), std::string::npos);
  EXPECT_NE(obj_error("vt").find("a.obj:1: vt has no"), std::string::npos);
  EXPECT_NE(obj_error("vn 1 2").find("a.obj:1: vn has 2"), std::string::npos);
  EXPECT_EQ(obj_error(three_vertices + "\nf 1 2 4\n"), "a.obj:5: f names v 4 of 3; is the file whole?");
  for (const char* rest : {"f", "f ", "f 1", "f 1 2"})
    EXPECT_NE(obj_error(three_vertices + "f 1 2 3\n" + rest).find("the file ends in a face of "), std::string::npos)
        << rest;
  EXPECT_EQ(obj_error(three_vertices + "f 1 2\n"), "no error") << "a line may have no area";
  EXPECT_EQ(obj_error(three_vertices + "f 1 2 3"), "no error");
  EXPECT_EQ(obj_error(three_vertices + "f 1/1 2/1 3/1\n"), "a.obj:4: f names vt 1 of 0; is the file whole?");
  EXPECT_EQ(obj_error(three_vertices + "f 1//9 2//1 3//1\n"), "a.obj:4: f names vn 9 of 0; is the file whole?");
  EXPECT_EQ(obj_error(three_vertices + "f 1 2 0\n"), "a.obj:4: \"0\": there is no such v; 3 so far");
  EXPECT_EQ(obj_error(three_vertices + "f 1 2 -4\n"), "a.obj:4: \"-4\": there is no such v; 3 so far");
  for (const char* f : {"f a b c", "f 1 2 3x", "f 1.5 2 3", "f 1 2 3/1/1/1", "f 1 2 99999999999999999999", "f 1 2 ++3"})
    EXPECT_NE(obj_error(three_vertices + f).find("a.obj:4: \""), std::string::npos) << f;
}

TEST(MeshObj, missing_files) {
  EXPECT_THROW(read_obj("/no/such/file.obj", {}), Error);
  EXPECT_THROW(read_obj("/", {}), Error);
}

TEST(MeshObj, a_large_mesh_survives) {
  const Mesh sphere = make_sphere(224, 224);
  std::string text;
  for (const Vec3& p : sphere.positions) {
    char line[128];
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    text += line;
  }
  for (const glm::uvec3& t : sphere.triangles)
    text += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " + std::to_string(t.z + 1) + "\n";
  const Mesh m = obj(text);
  ASSERT_EQ(m.triangles.size(), sphere.triangles.size());
  for (size_t i = 0; i < m.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(m.positions[m.triangles[i][k]], sphere.positions[sphere.triangles[i][k]]);
}

TEST(MeshObj, reads_the_scenes_of_the_sources) {
  const Mesh m = read_obj(kit::source_path("scenes/ajar/models/chair.obj"), {});
  EXPECT_EQ(kit::unsound(m), "");
  EXPECT_GT(m.triangles.size(), 10u);
}

}  // namespace
}  // namespace ajar
