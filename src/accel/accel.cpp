#include "ajar/accel/accel.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <atomic>
#include <bit>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/scene/cutout.h"
#include "ids.h"
#include "quadric.h"

namespace ajar {
namespace {

struct Quadric {
  const Shape* shape;
  uint32_t index;      // among the scene's shapes
  uint32_t geometry;   // what the ray tracer knows it by
  const Scene* scene;  // of a shape with masks; else null
};
struct CutOut {
  const Scene* scene;
  uint32_t shape;
};

uint64_t bits_of(float a, float b) { return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b); }

// Whether a point of a shape with masks stops a ray. Where a mask is between open and opaque the ray's own bits decide,
// so that the same ray always goes the same way.
bool stops(const Scene& scene, const Vec3& o, const Vec3& d, uint32_t shape, uint32_t prim, const Vec2& bary) {
  const float share = opacity(scene, shape, prim, bary);
  if (share <= 0 || share >= 1) return share >= 1;
  uint64_t h = hash(bits_of(o.x, o.y), bits_of(o.z, d.x));
  h = hash(h, bits_of(d.y, d.z));
  h = hash(h, uint64_t(shape) << 32 | prim);
  return to_unit(uint32_t(hash(h, bits_of(bary.x, bary.y)) >> 32)) < share;
}

void filter_cut_out(const RTCFilterFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const auto& cut = *static_cast<const CutOut*>(args->geometryUserPtr);
  const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const Vec3 o(ray.org_x, ray.org_y, ray.org_z), d(ray.dir_x, ray.dir_y, ray.dir_z);
  if (!stops(*cut.scene, o, d, cut.shape, hit.primID, {hit.u, hit.v})) args->valid[0] = 0;
}

struct DeviceRelease {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct SceneRelease {
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

void quadric_bounds(const RTCBoundsFunctionArguments* args) {
  const Shape& shape = *static_cast<const Quadric*>(args->geometryUserPtr)->shape;
  // Axis-aligned box of the transformed unit object's box: generous, never too small.
  const float z0 = shape.kind == ShapeKind::sphere ? -1.0f : 0.0f, z1 = shape.kind == ShapeKind::disk ? 0.0f : 1.0f;
  Vec3 lo(infinity), hi(-infinity);
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = shape.to_world * Vec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? z1 : z0, 1);
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  const Vec3 pad = (glm::abs(lo) + glm::abs(hi)) * 1e-6f;
  RTCBounds& b = *args->bounds_o;
  b.lower_x = lo.x - pad.x, b.lower_y = lo.y - pad.y, b.lower_z = lo.z - pad.z;
  b.upper_x = hi.x + pad.x, b.upper_y = hi.y + pad.y, b.upper_z = hi.z + pad.z;
}

// The first hit that is not where a mask lets the ray pass.
bool hit_quadric(const Quadric& quadric, const RTCRay& ray, double& t, glm::dvec3& p) {
  const Shape& shape = *quadric.shape;
  const glm::dmat4 m(shape.to_object);
  const glm::dvec3 o = m * glm::dvec4(ray.org_x, ray.org_y, ray.org_z, 1),
                   d = m * glm::dvec4(ray.dir_x, ray.dir_y, ray.dir_z, 0);
  for (double from = ray.tnear; intersect_quadric(shape.kind, o, d, from, ray.tfar, t, p); from = t) {
    if (!quadric.scene) return true;
    const Vec3 origin(ray.org_x, ray.org_y, ray.org_z), direction(ray.dir_x, ray.dir_y, ray.dir_z);
    if (stops(*quadric.scene, origin, direction, quadric.index, 0, quadric_uv(shape.kind, p))) return true;
  }
  return false;
}

void quadric_intersect(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const auto& quadric = *static_cast<const Quadric*>(args->geometryUserPtr);
  auto& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  double t;
  glm::dvec3 p;
  if (!hit_quadric(quadric, rayhit.ray, t, p)) return;
  const Vec2 uv = quadric_uv(quadric.shape->kind, p);
  rayhit.ray.tfar = float(t);
  rayhit.hit.u = uv.x, rayhit.hit.v = uv.y;
  rayhit.hit.primID = 0, rayhit.hit.geomID = quadric.geometry;
  rayhit.hit.instID[0] = args->context->instID[0];
}

void quadric_occluded(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  double t;
  glm::dvec3 p;
  if (hit_quadric(*static_cast<const Quadric*>(args->geometryUserPtr), ray, t, p)) ray.tfar = -infinity;
}

}  // namespace

struct Accel::Data {
  Device device;
  EmbreeScene top;
  std::vector<EmbreeScene> groups;
  std::vector<Quadric> quadrics;
  std::vector<CutOut> cut_outs;
  std::vector<uint64_t> marks;
  std::vector<uint32_t> grouped;         // shapes in groups, group by group
  std::vector<uint32_t> instance_first;  // by instance: where its group's begin among them
  std::atomic<int64_t> bytes{0};
};

namespace {

// Of a scene whose rays are longer, products of its coordinates with them would overflow.
constexpr float largest_stretched = 1e8f;

uint64_t mark_of(const Mat4& m) { return checksum(&m, sizeof m, 0); }

// How many triangles and corners it has, and where some of them are: a mesh that moved, or was bent, has others.
uint64_t mark_of(const Mesh& mesh) {
  const size_t n = mesh.positions.size(), step = std::max(n / 64, size_t(1));
  uint64_t mark = hash(mesh.triangles.size(), n);
  for (size_t i = 0; i < n; i += step) mark = checksum(&mesh.positions[i], sizeof mesh.positions[i], mark);
  return mark;
}

// What tells a scene's shapes and instances from those of another.
std::vector<uint64_t> marks_of(const Scene& scene) {
  std::vector<uint64_t> marks;
  marks.reserve(scene.shapes.size() + scene.instances.size());
  for (const Shape& s : scene.shapes)
    marks.push_back(s.kind == ShapeKind::mesh ? mark_of(scene.meshes[s.mesh])
                                              : hash(mark_of(s.to_world), ~uint64_t(s.kind)));
  for (const Instance& i : scene.instances) marks.push_back(hash(mark_of(i.to_world), i.group));
  return marks;
}

[[noreturn]] void refuse(RTCDevice device, const char* what) {
  throw Error(fmt::format("ray tracer: {} (error {}); is there enough memory?", what, int(rtcGetDeviceError(device))));
}

EmbreeScene new_scene(RTCDevice device) {
  EmbreeScene scene(rtcNewScene(device));
  // Watertight traversal: a door that leaks along its edges would ruin what Ajar is for.
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  return scene;
}

RTCGeometry mesh_geometry(RTCDevice device, const Mesh& mesh) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Copies: Embree wants padding after the last vertex, which a vector does not promise.
  auto* p = static_cast<Vec3*>(
      rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
  auto* t = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                             sizeof(glm::uvec3), mesh.triangles.size()));
  if (!p || !t) refuse(device, "no memory for a mesh");
  std::copy(mesh.positions.begin(), mesh.positions.end(), p);
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), t);
  return g;
}

void set_filter(RTCGeometry g, CutOut& cut) {
  rtcSetGeometryUserData(g, &cut);
  rtcSetGeometryIntersectFilterFunction(g, filter_cut_out);
  rtcSetGeometryOccludedFilterFunction(g, filter_cut_out);
}

RTCGeometry quadric_geometry(RTCDevice device, const Quadric* quadric) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, 1);
  rtcSetGeometryUserData(g, const_cast<Quadric*>(quadric));
  rtcSetGeometryBoundsFunction(g, quadric_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, quadric_intersect);
  rtcSetGeometryOccludedFunction(g, quadric_occluded);
  return g;
}

RTCGeometry instance_geometry(RTCDevice device, RTCScene group, const Instance& instance) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, group);
  rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &instance.to_world[0][0]);
  return g;
}

void attach(RTCScene scene, RTCGeometry g, uint32_t id) {
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

bool count_bytes(void* data, ssize_t bytes, bool) {
  static_cast<std::atomic<int64_t>*>(data)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

}  // namespace

Accel::Accel(const Scene& scene) : data_(std::make_unique<Data>()), first_instance_(uint32_t(scene.shapes.size())) {
  require_finished(scene);
  Data& data = *data_;
  data.marks = marks_of(scene);
  GeometryIds ids = number_geometries(scene);
  data.device.reset(rtcNewDevice(nullptr));
  if (!data.device) refuse(nullptr, "cannot start");
  RTCDevice device = data.device.get();
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &data.bytes);
  data.top = new_scene(device);
  for (uint32_t i = 0; i < scene.groups; ++i) data.groups.push_back(new_scene(device));
  data.quadrics.reserve(scene.shapes.size()), data.cut_outs.reserve(scene.shapes.size());
  for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[i];
    RTCScene into = shape.group == none ? data.top.get() : data.groups[shape.group].get();
    if (is_open(scene, shape)) continue;
    if (shape.kind != ShapeKind::mesh) {
      data.quadrics.push_back({&shape, i, ids.of_shape[i], shape.mask == none ? nullptr : &scene});
      attach(into, quadric_geometry(device, &data.quadrics.back()), ids.of_shape[i]);
    } else if (!scene.meshes[shape.mesh].triangles.empty()) {
      RTCGeometry g = mesh_geometry(device, scene.meshes[shape.mesh]);
      if (shape.mask != none) set_filter(g, data.cut_outs.emplace_back(CutOut{&scene, i}));
      attach(into, g, ids.of_shape[i]);
    }
  }
  for (auto& group : data.groups) rtcCommitScene(group.get());
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    data.instance_first.push_back(ids.first[instance.group]);
    attach(data.top.get(), instance_geometry(device, data.groups[instance.group].get(), instance), first_instance_ + i);
  }
  data.grouped = std::move(ids.shapes);
  rtcCommitScene(data.top.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) refuse(device, "cannot build");
  top_ = data.top.get();
  if (scene.radius > largest_stretched) stretch_ = 1;
}

Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;

bool Accel::fits(const Scene& scene) const { return data_ && data_->marks == marks_of(scene); }

size_t Accel::bytes() const { return size_t(std::max<int64_t>(data_->bytes.load(), 0)); }

namespace {

typedef float FourFloats __attribute__((vector_size(16), may_alias));

// By fours, as the ray tracer reads them: what is written in smaller parts it would wait for, until all are in the
// cache.
void set_ray(const Vec3& o, const Vec3& d, float t_min, float t_max, float stretch, RTCRay& ray) {
  const float shrink = 1 / stretch;
  auto* const fours = reinterpret_cast<FourFloats*>(&ray);
  fours[0] = FourFloats{o.x, o.y, o.z, t_min * shrink};
  fours[1] = FourFloats{stretch * d.x, stretch * d.y, stretch * d.z, 0};
  ray.tfar = t_max * shrink;
  ray.mask = ~0u, ray.id = 0, ray.flags = 0;
}

}  // namespace

bool Accel::intersect(const Vec3& o, const Vec3& d, float t_min, float t_max, Hit& hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit r;
  set_ray(o, d, t_min, t_max, stretch_, r.ray);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(static_cast<RTCScene>(top_), &context, &r);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.t = r.ray.tfar * stretch_;
  hit.prim = r.hit.primID;
  hit.instance = r.hit.instID[0] == RTC_INVALID_GEOMETRY_ID ? none : r.hit.instID[0] - first_instance_;
  hit.shape = r.hit.geomID;
  if (hit.instance != none) [[unlikely]]
    hit.shape = data_->grouped[data_->instance_first[hit.instance] + r.hit.geomID];
  hit.bary = {r.hit.u, r.hit.v};
  return true;
}

bool Accel::occluded(const Vec3& o, const Vec3& d, float t_max) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (!(t_max > 0)) return false;
  RTCRay ray;
  set_ray(o, d, 0, t_max, stretch_, ray);
  rtcOccluded1(static_cast<RTCScene>(top_), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace ajar
