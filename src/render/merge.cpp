// Merging: camera vertices take the light that arrives at light vertices near them (Georgiev et al. 2012).

#include "merge.h"
#include "contribution.h"

namespace ajar {
namespace {

// What takes part in a merge: surfaces that face the same way (cosine) and are not far above or below (of the radius).
constexpr float facing_share = 0.9f, plane_share = 0.2f;

// Of the light vertices that a camera vertex is merged with, so many are looked for.
constexpr int sights = 2;

// Merges beyond the first vertex that bring less than this share of what the sample has found are not all tried, but
// one in so many at least.
constexpr float worth_share = 0.1f, least_tried = 1.0f / 16;

// Smallest disc, of the radius.
constexpr float least_disc = 0.125f;

// Darts thrown for surface at most. Of those at a mask as many pass as its opacity says, but then a camera subpath
// seldom stops there: all in all they cost no more. The same goes for what keeps no light vertices.
constexpr int most_darts = 16, most_darts_at_holes = 4096;

// What lies above each other within a disc, and keeps no light vertices, that a dart goes through.
constexpr int most_bare = 8;

// The surface about a camera vertex that it can be merged with.
struct Disc {
  const Vertex& v;
  Frame frame;
  float radius = 0;
  float lift = 0;  // of lines of sight over the surface
};

// Angle [rad] about the mirror direction that a disc with the density there would fill: 1 for diffuse surfaces.
float lobe_width(const Guide& guide) {
  const Vec3 wo = guide.wo_local;
  const float pdf = eval(guide.bsdf, wo, {-wo.x, -wo.y, wo.z}, Mode::radiance).pdf;
  return std::min(1 / std::sqrt(pi * std::max(pdf, 1e-6f)), 1.0f);
}

// Light under a door changes within the height of the gap, so that the disc is smaller where something is near above.
// Lines of sight run as high as what is merged may lie, so that they do not slip under a door; under one, lower.
Disc disc_about(const Job& job, const Vertex& v, float radius) {
  const Frame frame = make_frame(v.guide.ng);
  Hit above;
  above.t = radius;
  job.accel->intersect(offset(v.p, v.ng, v.error, frame.n), frame.n, 0, radius, above);
  const float seen_in_it = 0.25f * lobe_width(v.guide) * std::sqrt(length2(v.p - job.walk.merging.eye));
  const float r = std::clamp(std::min(2 * above.t, seen_in_it), least_disc * radius, radius);  // (K8)
  return {v, frame, r, std::min(std::max(plane_share * r, 4 * v.error), 0.5f * above.t)};
}

// Whether what arrives at the photon would arrive at the camera vertex, as far as a disc of this radius reaches:
// surfaces that face other ways, and those that lie in front of it or behind, are others.
bool same_surface(const Vertex& v, float radius, const Photon& p) {
  if (!(length2(p.p - v.p) < sqr(radius))) return false;
  const float facing = glm::dot(v.guide.ng, p.n);
  if ((v.guide.bsdf.opaque ? facing : std::abs(facing)) < facing_share) return false;
  return std::abs(glm::dot(v.guide.ng, p.p - v.p)) < plane_share * radius;
}

// Whether nothing stands between the vertex and a place on its disc. What is behind a wall that stands on the disc is
// another surface, lit by other lights, and what lies within a solid that stands there is none.
bool sees(const Job& job, const Disc& disc, const Vec3& place) {
  return visible(*job.accel, {disc.v.p + disc.frame.n * disc.lift, place - disc.v.p, 1});
}

// Whether light vertices are kept on the side of n (add_photons): not on mirrors, clear glass and what is black.
bool keeps_light(const Scene& scene, const Surface& at, const Vec3& n) {
  Frame frame = at.frame;
  Bsdf bsdf;
  resolve(scene, at, n, frame, bsdf);
  return bsdf.has_smooth;
}

// Whether a dart from above the disc hits surface of it; it goes through what is bare of light vertices.
bool hits(const Job& job, const Disc& disc, Vec3 from, bool& bare) {
  const Vec3& n = disc.frame.n;
  float left = 2 * plane_share * disc.radius;
  for (int i = 0; i < most_bare; ++i) {
    Hit hit;
    if (!job.accel->intersect(from, -n, 0, left, hit)) return false;
    const Surface at = make_surface(*job.scene, hit, from, -n);
    if (keeps_light(*job.scene, at, n)) return std::abs(glm::dot(at.ng, n)) > facing_share && sees(job, disc, at.p);
    bare = true;
    from = offset(at.p, at.ng, at.error, -n);
    left -= hit.t;
  }
  return false;
}

// One over the share of the disc that is surface with light vertices, so that what lies at an edge or in a corner is
// not taken for dark: the mean number of darts until one hits (Booth 2007).
float over_coverage(const Job& job, const Disc& disc, Sampler& sampler) {
  const float height = plane_share * disc.radius;
  bool holes = job.scene->shapes[disc.v.shape].mask != none;
  int darts = 1;
  for (; darts < (holes ? most_darts_at_holes : most_darts); ++darts) {
    const Vec2 u = sampler.next2();
    const float r = disc.radius * std::sqrt(u.x), phi = 2 * pi * u.y;
    if (hits(job, disc, disc.v.p + disc.frame.to_world({r * std::cos(phi), r * std::sin(phi), height}), holes)) break;
  }
  return float(darts);  // (K4)
}

// The share of what light vertices bring that comes from those in sight: of a few, evenly spaced over the sums. Where
// all are in sight it is sure.
float share_in_sight(const Job& job, const Disc& disc, const std::vector<NearPhoton>& near, float u) {
  const float sum = near.back().sum;
  size_t i = 0;
  int seen = 0;
  for (int k = 0; k < sights; ++k) {
    const float mark = (float(k) + u) / sights * sum;
    while (i + 1 < near.size() && !(mark < near[i].sum)) ++i;
    seen += sees(job, disc, near[i].photon->p);
  }
  return float(seen) / sights;  // (K7)
}

// Sums over the merges at one camera vertex, by s; the last, of all longer light subpaths, has no image (pyramid.h).
struct Merged {
  std::array<Rgb, most_vertices + 1> raw{}, weighted{};
};

// The probability of looking at merges for which rays must be traced, which would add so much to what was found before.
float chance_to_try(float adds, float found) {
  return std::clamp(adds / (worth_share * found), least_tried, 1.0f);  // (K9)
}

void add_merged(const Merged& sums, int t, const Rgb& factor, Sample& sample, Scratch& scratch) {
  for (int s = 2; s <= most_vertices; ++s) {
    const Rgb found = sums.weighted[size_t(s)] * factor;
    if (!is_black(found)) add_to_pixel(sample, scratch, -s, t, sums.raw[size_t(s)] * factor, found);
  }
}

// Numbers of the merges at the t-th camera vertex. Each ray of a final gather has others: whether one is looked at (K9)
// must say nothing of the next, which is held against what both found.
Sampler own_numbers(const Job& job, const Sample& sample, int t) {
  const uint64_t place = 0xd15c + uint64_t(t) + (uint64_t(sample.gathers) << 32);
  return make_sampler(SamplerKind::independent, hash(job.seed, place), Side::camera, sample.path, sample.pass);
}

// What all light vertices within the radius would bring, were they in sight. Returns the luminance of their sum.
float find_near(const Job& job, const Subpath& camera, bool inner, float radius, Scratch& scratch) {
  const int t = camera.n, most = job.walk.max_edges + 2 - t;
  const Vertex& v = camera[t - 1];
  const SampleCounts& counts = job.walk.counts;
  const MergeSide side =
      merge_side(job.walk.heuristic, end_at(camera.first(t), 0, 0), v.back, counts.light_paths, counts);
  float sum = 0;
  scratch.near.clear();
  for_each_near(inner ? job.photons->few : job.photons->all, v.p, radius, [&](const Photon& p) {
    const float cosine = std::abs(glm::dot(v.guide.ng, p.wi));
    if (p.s > most || !same_surface(v, radius, p) || !(cosine > 1e-6f)) return;
    if (job.final_gather > 0 && !inner && !p.straight) return;  // what gathers bring
    const GuideEval e = evaluate(v.guide, p.wi, Mode::radiance);
    if (is_black(e.f_cos)) return;
    ++scratch.ledger->merge_at(p.s, t).joins;
    const MergeSide light{v.seen ? p.fixed * seen_factor(job.walk.heuristic, counts, p.s) : p.fixed, p.slope};
    const double w =
        job.merges_alone ? 1 : merge_weight(job.walk.heuristic, v.merge, light, e.pdf, side, e.pdf_reverse);
    scratch.near.push_back({&p, e.f_cos * p.beta / cosine, float(w)});  // (K1)
    sum += luminance(scratch.near.back().found) * float(w);
  });
  return sum;
}

// Forgets what is not on the disc, and sums up the others.
Merged sum_up(const Disc& disc, std::vector<NearPhoton>& near) {
  Merged sums;
  float sum = 0;
  std::erase_if(near, [&](const NearPhoton& n) { return !same_surface(disc.v, disc.radius, *n.photon); });
  for (NearPhoton& n : near) {
    const size_t row = size_t(std::min(n.photon->s, most_vertices));
    sums.raw[row] += n.found;
    sums.weighted[row] += n.found * n.weight;
    n.sum = sum += luminance(n.found) * n.weight;
  }
  return sums;
}

// Whether the sample is one of every n; other ones from pass to pass.
bool is_one_in(uint32_t n, const Sample& sample) { return hash(sample.path / n, sample.pass) % n == sample.path % n; }

}  // namespace

void keep_photons(const Job& job, const Sample& sample, Scratch& scratch) {
  const WalkOptions& walk = job.walk;
  Photons& photons = scratch.halves->photons;
  const size_t first = photons.size();
  add_photons(photons, scratch.light, walk.heuristic, walk.counts);
  if (walk.counts.merge_inner > 0 && is_one_in(inner_photons, sample))
    scratch.halves->few.insert(scratch.halves->few.end(), photons.begin() + ptrdiff_t(first), photons.end());
}

void join_merged(const Job& job, Sample& sample, Scratch& scratch) {
  const Subpath& camera = scratch.camera;
  const int t = camera.n;
  const Vertex& v = camera[t - 1];
  if (!(v.merge > 0)) return;
  const float radius = merge_radius(job.walk.merging, v.p), full = merge_density(job.walk.merging, v.p);
  const bool inner = v.merge < full;
  const float stands_for = inner ? float(inner_photons) : 1;  // light vertices, each
  std::vector<NearPhoton>& near = scratch.near;
  const float sum = find_near(job, camera, inner, radius, scratch);
  if (!near.empty() && !(sum <= 0)) {  // what is no number is counted when it is added
    Sampler sampler = own_numbers(job, sample, t);
    const Vec2 u = sampler.next2();
    const float adds = luminance(v.beta) * sum * stands_for / full;
    const float tried = inner ? chance_to_try(adds, luminance(sample.value)) : 1;
    if (u.y >= tried) return charge(scratch, scratch.ledger->merge_at(0, t).ticks);
    const Disc disc = disc_about(job, v, radius);
    const Merged sums = sum_up(disc, near);
    const float of_disc = full * sqr(disc.radius / radius) * tried;
    const float seen = near.empty() ? 0 : share_in_sight(job, disc, near, u.x);
    if (seen > 0)
      add_merged(sums, t, v.beta * (stands_for * seen * over_coverage(job, disc, sampler) / of_disc), sample, scratch);
  }
  charge(scratch, scratch.ledger->merge_at(0, t).ticks);
}

}  // namespace ajar
