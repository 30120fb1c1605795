// Enters: what the loader or a builder made.
// Leaves: the whole scene as data: arrays that name each other by index.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ajar/scene/camera.h"
#include "ajar/scene/filter.h"
#include "ajar/scene/light.h"
#include "ajar/scene/lighttree.h"
#include "ajar/scene/material.h"

namespace ajar {

/// A vertex as make_surface reads it: all of it in half a cache line.
struct alignas(32) PackedVertex {
  Vec3 p{0};
  float u = 0;
  Vec3 n{0};
  float v = 0;
};

/// A triangle as make_surface reads it.
struct alignas(32) PackedTriangle {
  glm::uvec3 v{0};
  float error = 0;   ///< Surface::error of its points
  Vec3 ng{0, 0, 1};  ///< unit, by the winding
};

/// Numbers that a file ties to the vertices or the faces of its mesh: "vertex_wetness", "face_color". Single numbers
/// are grey.
struct Attribute {
  std::string name;
  bool of_faces = false;    ///< values belong to triangles, not to vertices
  std::vector<Rgb> values;  ///< as many as the mesh has of them
};

/// Triangles in world space (in the group's space for shapes of a shapegroup). normals, uvs and colors may be
/// empty.
struct alignas(64) Mesh {
  // made by finish: all that make_surface asks for, in one cache line
  std::vector<PackedVertex> packed;  ///< positions, normals and uvs side by side
  std::vector<PackedTriangle> faces;
  bool smooth = false;  ///< has normals
  bool mapped = false;  ///< has uvs

  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< unit; empty: face normals
  std::vector<Vec2> uvs;
  std::vector<glm::uvec3> triangles;
  std::vector<Rgb> colors;            ///< per vertex, the attribute vertex_color
  std::vector<Attribute> attributes;  ///< all others
  Distribution area;                  ///< over triangles; filled by finish for meshes that emit
  double total_area = 0;
};

enum class ShapeKind : uint8_t { mesh, sphere, disk, cylinder };

/// Quadrics are unit objects under to_world: sphere of radius 1 at 0; disk of radius 1 in z = 0, normal +z;
/// cylinder of radius 1 about z from 0 to 1, open, normal outwards. sphere: to_world is a similarity.
struct Shape {
  ShapeKind kind = ShapeKind::mesh;
  bool flip = false;     ///< turns ng (meshes were turned by the loader)
  bool tangents = true;  ///< hits get dpdu, dpdv and a frame turned to them; finish clears it where no bsdf asks
  uint32_t mesh = none;
  uint32_t material = 0;
  uint32_t mask = none;  ///< what material was (or, of a sum, still is) with masks, where rays ask it (cutout.h)
  uint32_t light = none;
  uint32_t group = none;  ///< belongs to a shapegroup: seen only through instances
  Mat4 to_world{1};
  Mat4 to_object{1};  ///< its inverse, made by finish
  std::string name;   ///< for messages
};

struct Instance {
  uint32_t group = 0;
  Mat4 to_world{1};
  Mat4 to_object{1};  ///< its inverse, made by finish
};

/// What the file says about rendering; the command line overrules it.
struct Hints {
  std::string integrator;                               ///< as named by the file
  int max_depth = -1;                                   ///< edges, -1 unlimited
  int spp = 0;                                          ///< 0: not said
  double first_time = infinity, last_time = -infinity;  ///< of all <animation> keys; first > last: nothing moves
};

struct Scene {
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Shape> shapes;
  std::vector<Instance> instances;
  uint32_t groups = 0;  ///< number of shapegroups
  std::vector<Environment> environments;
  std::vector<Light> lights;
  Camera camera;
  Filter filter;
  Hints hints;
  uint64_t content = 0;            ///< checksum of all files that it was read from; 0: made by code
  std::vector<std::string> files;  ///< that it was read from
  std::vector<std::string> notes;  ///< what the loader wants the user to know, one line each

  // made by finish()
  LightTree light_tree;
  std::vector<uint32_t> infinite_lights;  ///< constant, envmap and sun: those an escaping ray finds
  Vec3 center{0};                         ///< bounding sphere of everything that can be hit
  float radius = 1;
  bool finished = false;  ///< what adds parts (build.h) clears it
};

/// What may be hit, seen from or lit from is at most so many units away: beyond, the ray tracer's squares of distances
/// are no numbers.
inline constexpr float farthest = 1e18f;

/// Computes what is derived (inverses, areas, bounds, light choice; directions become unit); call once after building
/// or changing a scene. Throws Error where parts do not fit (an index that leads nowhere, lists of a mesh or image of
/// other lengths than they say, an area light and a shape that do not name each other), where a colour of a material or
/// light, or of an image that is one, or a light's sampling_weight, is not finite or negative, where something reaches
/// or stands beyond `farthest`, where the transform of an environment, spot or projector cannot be inverted, for a
/// camera without a view, a lens or a place for its crop window, or with clip planes that are none, for a lamp in a
/// group, a sphere that is not round, a sun, a spot or a projector without extent, and for bsdfs that cannot be (one
/// that is part of itself, an index of refraction below 0).
void finish(Scene& scene);
/// Throws Error unless finish was called since the scene was built or added to. Changes that leave all numbers of parts
/// as they are go unnoticed, but a camera that has no view.
void require_finished(const Scene& scene);
/// Has next-event estimation choose another way, also after the scene is finished (anew). learned is tree, for fields
/// to do better.
void set_light_choice(Scene& scene, LightChoice choice);
/// Triangles of all meshes, each once however often it is placed.
uint64_t count_triangles(const Scene& scene);

}  // namespace ajar
