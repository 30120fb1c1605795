#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "kit/files.h"
#include "mesh_samples.h"

namespace ajar {
namespace {

Mesh ply(const std::string& bytes, const MeshOptions& options = {.face_normals = true}) {
  Mesh mesh = parse_ply(kit::as_bytes(bytes), "a.ply", options);
  EXPECT_EQ(kit::unsound(mesh), "");
  return mesh;
}

std::string ply_error(const std::string& bytes) {
  try {
    parse_ply(kit::as_bytes(bytes), "a.ply", {});
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "no error";
}

std::string ascii(const std::string& vertex, const std::string& faces, const std::string& body, int vertices = 3) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) + "\n" + vertex + faces + "end_header\n" +
         body;
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string one_face = "element face 1\nproperty list uchar int vertex_indices\n";

TEST(MeshPly, ascii) {
  const Mesh m = ply(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  ASSERT_EQ(m.triangles.size(), 1u);
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 0));
  EXPECT_TRUE(m.normals.empty() && m.uvs.empty() && m.colors.empty());
}

TEST(MeshPly, crlf_header_comments_and_vertex_index) {
  const Mesh m =
      ply("ply\r\ncomment a\r\nformat ascii 1.0\r\nobj_info b\r\n\r\nelement vertex 3\r\nproperty double x\r\n"
          "property float32 y\r\nproperty float64 z\r\nelement face 1\r\nproperty list int32 uint16 vertex_index\r\n"
          "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n");
  EXPECT_EQ(m.triangles[0], glm::uvec3(0, 1, 2));
}

TEST(MeshPly, every_spelling_of_uv_and_colour) {
  for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}) {
    const std::string vertex = xyz + "property float " + u + "\nproperty float " + v + "\n";
    const std::string body = "0 0 0 0.25 0.75\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
    EXPECT_EQ(ply(ascii(vertex, one_face, body)).uvs[0], Vec2(0.25f, 0.75f));
    EXPECT_EQ(ply(ascii(vertex, one_face, body), {.flip_v = true}).uvs[0], Vec2(0.25f, 0.25f));
  }
  for (const char* first : {"u", "s"}) {  // where there are several, u and v count
    std::string vertex = xyz;
    for (const std::string name :
         first == std::string("u") ? std::array{"u", "v", "s", "t"} : std::array{"s", "t", "u", "v"})
      vertex += "property float " + name + "\n";
    const Mesh m = ply(ascii(vertex, one_face, "0 0 0 1 2 3 4\n1 0 0 1 2 3 4\n0 1 0 1 2 3 4\n3 0 1 2\n"));
    EXPECT_EQ(m.uvs[0], first == std::string("u") ? Vec2(1, 2) : Vec2(3, 4));
  }
  const std::string body = "0 0 0 255 51 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n";
  const std::string bytes = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  EXPECT_EQ(ply(ascii(xyz + bytes, one_face, body)).colors[0], Rgb(1, 0.2f, 0));
  const std::string floats = "property float r\nproperty float g\nproperty float b\n";
  EXPECT_EQ(ply(ascii(xyz + floats, one_face, body)).colors[0], Rgb(255, 51, 0));
}

// Named by Mitsuba's convention; a value of a face goes to each of its triangles.
TEST(MeshPly, attributes_of_vertices_and_faces) {
  const std::string vertex = xyz +
                             "property float heat_x\nproperty uchar tint_r\nproperty uchar tint_g\nproperty uchar "
                             "tint_b\nproperty uchar tint_a\nproperty float pair_0\nproperty float pair_1\nproperty "
                             "int step_1\nproperty int step_2\nproperty int step_3\nproperty float odd_y\n";
  const std::string faces =
      "element face 3\nproperty uchar red\nproperty list uchar int vertex_indices\nproperty uchar green\n"
      "property uchar blue\nproperty float id_0\n";
  const Mesh m = ply(ascii(vertex, faces,
                           "0 0 0 0.5 255 0 51 9 1 2 7 8 9 3\n4 0 0 1.5 0 0 0 9 1 2 0 0 0 3\n"
                           "4 4 0 0 0 0 0 9 1 2 0 0 0 3\n0 4 0 0 0 0 0 9 1 2 0 0 0 3\n"
                           "255 2 0 1 0 0 1\n0 4 0 1 2 3 255 0 2\n0 3 0 1 2 0 255 3\n",
                           4));
  ASSERT_EQ(m.attributes.size(), 5u);
  EXPECT_TRUE(m.colors.empty());
  EXPECT_EQ(m.attributes[0].name, "vertex_heat");
  EXPECT_EQ(m.attributes[0].values[1], Rgb(1.5f));
  EXPECT_EQ(m.attributes[1].name, "vertex_tint_color");
  EXPECT_EQ(m.attributes[1].values[0], Rgb(1, 0, 0.2f));
  EXPECT_EQ(m.attributes[2].name, "vertex_step");
  EXPECT_EQ(m.attributes[2].values[0], Rgb(7, 8, 9));
  EXPECT_FALSE(m.attributes[2].of_faces);
  ASSERT_EQ(m.triangles.size(), 3u);
  EXPECT_EQ(m.attributes[3].name, "face_color");
  EXPECT_TRUE(m.attributes[3].of_faces);
  EXPECT_EQ(m.attributes[3].values, (std::vector{Rgb(0, 1, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)}));
  EXPECT_EQ(m.attributes[4].name, "face_id");
  EXPECT_EQ(m.attributes[4].values[2], Rgb(3));
  // smoothed anew: vertices are made again, their attributes with them
  const std::string corner = "0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n3 0 1 2 5\n3 0 3 1 6\n";
  const Mesh cut =
      ply(ascii(xyz + "property float heat_0\n",
                "element face 2\nproperty list uchar int vertex_indices\nproperty float id_0\n", corner, 4),
          {.max_smooth_angle = 10});
  ASSERT_EQ(cut.positions.size(), 6u);
  ASSERT_EQ(cut.attributes[0].values.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    const Vec3& p = cut.positions[i];
    EXPECT_EQ(cut.attributes[0].values[i], Rgb(1 + p.x + 2 * p.y + 3 * p.z));
  }
  EXPECT_EQ(cut.attributes[1].values, (std::vector{Rgb(5), Rgb(6)}));
}

// Mitsuba 2 and 3: whatever they are of; floats stay.
TEST(MeshPly, integers_may_be_encoded_parts) {
  const std::string vertex = xyz +
                             "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty short step_x\n"
                             "property short step_y\nproperty short step_z\nproperty float heat_0\n";
  const std::string faces =
      "element face 1\nproperty list uchar int vertex_indices\nproperty uint id_0\nproperty float cost_0\n";
  const std::string body =
      "0 0 0 128 255 0 -32767 0 16384 7\n1 0 0 0 0 0 0 0 0 7\n0 1 0 0 0 0 0 0 0 7\n3 0 1 2 4294967295 9\n";
  const auto near = [](const Rgb& a, const Rgb& b) { return max_component(glm::abs(a - b)) < 1e-4f; };
  for (const bool encoded : {false, true}) {
    const Mesh m = ply(ascii(vertex, faces, body), {.face_normals = true, .encoded = encoded});
    EXPECT_TRUE(near(m.colors[0], encoded ? Rgb(0.21586f, 1, 0) : Rgb(128 / 255.0f, 1, 0)));
    EXPECT_TRUE(near(m.attributes[0].values[0], encoded ? Rgb(-1 / 12.92f, 0, 0.21406f) : Rgb(-32767, 0, 16384)));
    EXPECT_EQ(m.attributes[1].values[0], Rgb(7));
    EXPECT_EQ(m.attributes[2].values[0], encoded ? Rgb(1) : Rgb(4294967295.0f));
    EXPECT_EQ(m.attributes[3].values[0], Rgb(9));
  }
}

TEST(MeshPly, polygons_and_quads) {
  const Mesh m = ply(ascii(xyz, "element face 2\nproperty list uchar int vertex_indices\n",
                           "0 0 0\n4 0 0\n1 1 0\n0 4 0\n4 0 1 2 3\n2 0 1\n", 4));
  ASSERT_EQ(m.triangles.size(), 2u);  // a concave quad; the other face has no area
  EXPECT_EQ(kit::face_normal(m, 0), Vec3(0, 0, 1));
  EXPECT_EQ(kit::face_normal(m, 1), Vec3(0, 0, 1));
}

TEST(MeshPly, unknown_properties_and_elements_are_skipped) {
  const Mesh m = ply(
      "ply\nformat ascii 1.0\nelement camera 2\nproperty list int float l\nproperty int n\n"
      "element vertex 3\nproperty float quality\nproperty float x\nproperty list uchar int ring\nproperty float y\n"
      "property float z\nelement face 1\nproperty uchar flag\nproperty list uchar uint vertex_indices\n"
      "property list uchar float texcoord\nelement edge 1\nproperty int a\nelement nothing 99999999999\nend_header\n"
      "2 0.5 0.5 7\n0 7\n9 0 2 1 2 0 0\n9 1 0 0 0\n9 0 1 5 1 0\n1 3 2 1 0 2 0.5 0.5\n3\n");
  EXPECT_EQ(m.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(m.triangles[0], glm::uvec3(2, 1, 0));
}

TEST(MeshPly, binary_of_both_byte_orders_and_all_types) {
  for (const bool big : {false, true}) {
    std::string b =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement vertex 3\nproperty double x\nproperty short y\nproperty char z\n"
        "property ushort red\nproperty uint green\nproperty float blue\nproperty list ushort double skipped\n"
        "element face 1\nproperty list ushort uchar vertex_indices\nproperty int tag\nend_header\n";
    for (int i = 0; i < 3; ++i) {
      kit::put(b, double(i) * 0.5, big), kit::put(b, int16_t(-i * 300), big), kit::put(b, int8_t(i == 2 ? -2 : 0), big);
      kit::put(b, uint16_t(65535), big), kit::put(b, uint32_t(0), big), kit::put(b, 0.5f, big);
      kit::put(b, uint16_t(i), big);
      for (int k = 0; k < i; ++k) kit::put(b, 1.0, big);
    }
    kit::put(b, uint16_t(3), big);
    for (uint8_t i : {0, 1, 2}) kit::put(b, i, big);
    kit::put(b, int32_t(-5), big);
    const Mesh m = ply(b);
    EXPECT_EQ(m.positions[2], Vec3(1, -600, -2));
    EXPECT_EQ(m.colors[1], Rgb(1, 0, 0.5f));
    EXPECT_EQ(m.triangles[0], glm::uvec3(0, 1, 2));
    for (size_t n = b.size() - 1; n > b.size() - 60; --n) EXPECT_THROW(ply(b.substr(0, n)), Error) << n;
  }
}

TEST(MeshPly, a_large_mesh_survives) {
  Mesh sphere = make_sphere(224, 224);
  sphere.colors.assign(sphere.positions.size(), Rgb(1, 0, 0.2f));
  ASSERT_GT(sphere.triangles.size(), 99000u);
  for (const bool big : {false, true}) {
    const Mesh m = ply(kit::ply_of(sphere, big), MeshOptions());
    EXPECT_EQ(m.positions, sphere.positions);
    EXPECT_EQ(m.uvs, sphere.uvs);
    EXPECT_EQ(m.colors, sphere.colors);
    EXPECT_EQ(m.triangles, sphere.triangles);
    ASSERT_EQ(m.normals.size(), sphere.normals.size());
    for (size_t i = 0; i < m.normals.size(); ++i) ASSERT_LT(glm::distance(m.normals[i], sphere.normals[i]), 1e-6f);
  }
}

TEST(MeshPly, faces_may_come_before_vertices) {
  const Mesh m = ply("ply\nformat ascii 1.0\n" + one_face + "element vertex 3\n" + xyz +
                     "end_header\n3 2 0 1\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(m.triangles[0], glm::uvec3(2, 0, 1));
}

TEST(MeshPly, errors_say_what_and_where) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(ply_error(text).find(part), std::string::npos) << ply_error(text);
  };
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  has("", "a.ply:1: PLY header: no end_header");
  has("plyx\nend_header\n", "a.ply:1: PLY header: the first line is not \"ply\"");
  has("ply\nformat ascii 1.0\n", "no end_header");
  has("ply\nend_header\n", "no format line");
  has("ply\nformat zip 1.0\nend_header\n", "a.ply:2: PLY header: unknown format \"zip\"");
  has("ply\nformat\nend_header\n", "a.ply:2: PLY header: \"format\" lacks a word");
  has("ply\nproperty int x\nend_header\n", "a property before the first element");
  has("ply\nfoo\nend_header\n", "unknown keyword \"foo\"");
  has("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "\"-1\" is not a number of elements");
  has("ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n", "unknown type \"quad\"");
  has(ascii("property float x\n", "", "0 0 0"), "element vertex lacks x, y or z");
  has(ascii(xyz, "element face 1\nproperty int a\n", body), "element face lacks the list vertex_indices");
  has(ascii(xyz, "element face 1\nproperty list uchar float vertex_indices\n", body), "not integers");
  has(ascii(xyz, "element face 1\nproperty list float int vertex_indices\n", body), "not an integer");
  has(ascii(xyz, "element tristrips 1\nproperty list int int vertex_indices\n", body), "triangle strips");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"), "face 0 names vertex 3 of 3");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), "face 0 of 1: vertex index -1");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n"), "vertex index 0.5");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), "list length -3");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n300000 0 1\n"), "a list of 300000 entries");
  has(ascii(xyz, one_face, "0 0 0\n1 0 0\n0 1 0\n3 0 1 "), "face 0 of 1: ");
  has(ascii(xyz, one_face, "0 0 0\n1 0x 0\n0 1 0\n3 0 1 2\n"), "vertex 1 of 3: \"0x");
  has(ascii(xyz, one_face, "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "vertex 1 is not finite");
  has(ascii(xyz, one_face, "0 0 0\n1 1e39 0\n0 1 0\n3 0 1 2\n"), "vertex 1 is not finite");
  EXPECT_THROW(read_ply("/no/such/file.ply", {}), Error);
}

TEST(MeshPly, promises_beyond_the_file_allocate_nothing) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\n" + xyz;
  EXPECT_NE(ply_error(head + "end_header\nabc").find("1000000000000 x vertex"), std::string::npos);
  const std::string faces = "ply\nformat binary_little_endian 1.0\nelement vertex 0\n" + xyz +
                            "element face 1\nproperty list uint int vertex_indices\nend_header\n\xff\xff\xff\xff";
  EXPECT_NE(ply_error(faces).find("a list of 4294967295 entries"), std::string::npos);
}

TEST(MeshPly, reads_the_scenes_of_the_sources) {
  EXPECT_GT(ply(read_bytes(kit::source_path("scenes/ajar/models/teapot.ply")), MeshOptions()).triangles.size(), 10u);
}

}  // namespace
}  // namespace ajar
