// Enters: OBJ, PLY and Mitsuba serialized files (or their bytes), names of simple shapes.
// Leaves: triangle meshes, checked: indices in range, positions finite, normals unit, winding on the side of the
// normals.
#pragma once

#include <cstddef>
#include <fstream>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ajar/scene/scene.h"

namespace ajar {

// Which side is outside (what emits, what is the inside of glass)? The side that the triangle's winding turns
// counterclockwise, after the following, so that ng = normalised cross(p1 - p0, p2 - p0) needs no further thought:
// - A mesh with normals of its own: they decide, as in Mitsuba, which turns the geometric normal to the side of the
//   shading normal. A triangle wound against the sum of its three normals is wound anew. Normals are mapped by the
//   inverse transpose, so a mirror keeps outside outside.
// - A file without normals (or with face_normals): its winding in world space decides, as in Mitsuba. A mirror turns it
//   inside out.
// - Rectangle and cube keep their outside under a mirror, as Mitsuba's do: transform() winds anew. So does the sphere
// of
//   0.x; the later one and all cylinders are turned inside out.

/// What the shape element of a scene says about its mesh.
struct MeshOptions {
  bool face_normals = false;      ///< no interpolated normals: those of the file are dropped, none are computed
  bool flip_normals = false;      ///< turns the surface inside out: winding and normals
  bool flip_v = false;            ///< v becomes 1 - v
  float max_smooth_angle = -1;    ///< degrees; 0 or more: normals are made anew, edges sharper than this stay sharp
  std::string material;           ///< OBJ: the faces under this usemtl alone; empty: all
  std::set<std::string> without;  ///< OBJ: no faces under these
  bool srgb = false;              ///< PLY: vertex_color is encoded as sRGB; whoever reads it has to decode it
  bool encoded = false;           ///< PLY: integers of attributes are parts of their type's largest, encoded as sRGB
  // OBJ, as Mitsuba 0.x has it:
  bool weld = false;   ///< corners without a normal share vertices by their position and uv, not by index
  bool apart = false;  ///< faces under different g or usemtl share no computed normals
  int group = -1;      ///< the faces of one of these groups alone, counted from 0
  /// Serialized, as Mitsuba 0.x has it: a mirror leaves the outside of a mesh without normals where it was.
  bool keeps_side = false;
  std::vector<std::string>* notes = nullptr;  ///< PLY: gets a line for what changes the image and is passed over
  Mat4 to_world{1};  ///< applied before normals are made, which a mirror or uneven scale would change
};

// All readers: a file without normals gets smooth ones (angle-weighted means over the faces at a vertex, Thürmer and
// Wüthrich 1998) unless face_normals is asked for. Normals are made unit; one that is missing, zero or not a number is
// computed from the faces like those of a file without normals, and where these have no area it is (0, 0, 1). Polygons
// become fans from their first corner; concave ones, of up to 256 corners, triangles that lie inside. Triangles without
// area stay. Texture coordinates that are not finite become 0. Throws Error that names the file and line, vertex or
// face: file unreadable, malformed or truncated, index out of range, position or colour not finite.

/// Wavefront OBJ, the whole file as one mesh: objects, groups (but see above), lines and curves are passed over.
/// Vertices with the same v, vt and vn index are shared. Faces of fewer than three corners have no area and are left
/// out.
Mesh read_obj(const std::string& path, const MeshOptions& options);
/// Stanford PLY 1.0, ascii or binary of either byte order. Integer colours are scaled to [0, 1].
Mesh read_ply(const std::string& path, const MeshOptions& options);
/// Mitsuba's serialized meshes, versions 3 and 4; shape_index counts from 0.
Mesh read_serialized(const std::string& path, int shape_index, const MeshOptions& options);

/// The same from memory; name stands in messages.
Mesh parse_obj(std::string_view text, const std::string& name, const MeshOptions& options);
Mesh parse_ply(std::span<const std::byte> bytes, const std::string& name, const MeshOptions& options);
Mesh parse_serialized(std::span<const std::byte> bytes, const std::string& name, int shape_index,
                      const MeshOptions& options);

/// [-1,1]^2 at z = 0, normal +z, uv (0,0) to (1,1); face normals.
Mesh make_rectangle();
/// [-1,1]^3, face normals outwards, uv (0,0) to (1,1) on each face, turned as Mitsuba's.
Mesh make_cube();
/// Polyhedron with its vertices on the unit sphere, rings cells from pole to pole (2 or more) times segments cells
/// around (3 or more), smooth normals outwards; u = azimuth / 2 pi, v = polar angle / pi from +z. For a sphere under a
/// transform that is no similarity.
Mesh make_sphere(int rings, int segments);

/// Moves a mesh into world space; outside stays outside, under a mirror too (see above). The matrix is affine, in
/// metres. Throws Error where a position leaves the range of numbers.
void transform(Mesh& mesh, const Mat4& to_world);

// What the readers share.

/// The texture coordinates, or 0 where one of them is not finite.
Vec2 finite_or_zero(const Vec2& uv);
/// A file to read from, and the bytes of one. Throw Error where it cannot be read.
std::ifstream open_bytes(const std::string& path);
std::string read_bytes(const std::string& path);
/// Appends a polygon's triangles; see above. The corners are vertices that exist.
void add_polygon(Mesh& mesh, std::span<const uint32_t> corners);
/// Last step of every reader: options, normals, sides. Normals that are zero or not finite count as missing.
void complete(Mesh& mesh, const MeshOptions& options, const std::string& name);

}  // namespace ajar
