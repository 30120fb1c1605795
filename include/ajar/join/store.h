// Enters: light subpaths of many samples.
// Leaves: for a camera vertex, some of all their vertices to join, drawn by what they are expected to bring.
#pragma once

#include <array>
#include <span>

#include "ajar/core/sampler.h"
#include "ajar/join/connect.h"

namespace ajar {

/// Vertices of light subpaths that can be joined (s >= 2), each with what joins read of the subpath. (pool.h keeps a
/// few.)
struct LightStore {
  struct Entry {
    uint32_t vertex = 0;        ///< which of the vertices
    int s = 0;                  ///< vertices of its subpath up to this one
    bool delta_before = false;  ///< see LightEnd
    bool only_joined = false;   ///< no walk finds what came here: a caustic of a light without extent
    double own_before = 1, nee_ratio = 1;
    uint32_t region = no_region;
    uint32_t path = 0;  ///< number of its subpath
    float counts = 1;   ///< for how many of its kind it stands, where others were left out
    float flux = 0;     ///< luminance that it scatters, see Block
    float worth = 0;    ///< what the fields expect it to bring to the image, direct view aside
    float near = 0;     ///< see Block
  };
  /// What a choice reads of so many entries, side by side.
  static constexpr uint32_t width = 32, runs = 8;
  struct alignas(64) Values {  ///< of the entries of a block; every eighth from one on makes a run
    float of[width] = {};
    float& operator[](size_t i) { return of[i]; }
    float operator[](size_t i) const { return of[i]; }
  };
  using Sums = std::array<float, runs>;  ///< of the runs up to and with each
  struct alignas(64) Block {
    float x[width] = {}, y[width] = {}, z[width] = {};
    float nx[width] = {}, ny[width] = {}, nz[width] = {};  ///< shading normal on the side that it is lit from
    float flux[width] = {};    ///< luminance that it scatters at right angles, taken as diffuse [per solid angle]; or 0
    float near[width] = {};    ///< (J1): geometry terms above 1 / near make the join the lesser strategy, if alike
    float behind[width] = {};  ///< -1 where it scatters to the other side too, else 0
    float wx[width] = {}, wy[width] = {}, wz[width] = {};                         ///< where its light comes from, unit
    float matt[width] = {}, peak[width] = {}, f0[width] = {}, alpha[width] = {};  ///< its Gloss
    uint32_t region[width] = {};
    uint32_t path[width] = {};
    int s[width] = {};
    uint32_t first = 0;   ///< where its entries begin among all
    uint32_t glossy = 0;  ///< of its entries from the first on, those for which wx to alpha say something (J6)
  };
  std::vector<Vertex> vertices;
  std::vector<Entry> entries;
  std::vector<Block> blocks;  ///< of entries, as deal_blocks or lay_blocks put them
  uint32_t paths = 0;         ///< light subpaths that were tried, those that brought no vertex too

  const Vertex& vertex(const Entry& at) const { return vertices[at.vertex]; }
  LightEnd end(const Entry& at) const { return {&vertex(at), at.s, at.delta_before, at.own_before, at.nee_ratio}; }
};

/// A camera vertex that is to be joined. What strategies count for is not raised.
struct Joiner {
  const Vertex* vertex = nullptr;
  int most = 0;     ///< largest s
  float worth = 0;  ///< what the vertex makes of what is brought, relative to what its pixel is expected to be; 0: not
                    ///< known, one join
  double counts = 1;    ///< what its joins count for in the weights (J7)
  double onwards = 1;   ///< the same of a join at the light's vertex, if the camera subpath went on to it
  double before = 1;    ///< the same of all with fewer camera vertices, if the light subpath came here
  float joins = 3;      ///< how many for a pixel's whole light (J3)
  uint32_t blocks = 1;  ///< of the store, that are looked at
};

struct StoreChoice {
  uint32_t entry = 0;  ///< which of the store's
  float weight = 0;    ///< with which the join counts: its sum over all entries, over light subpaths
};

void clear(LightStore& store);
void add(LightStore& store, const Subpath& light);
/// Makes the blocks, when all is added: each an even sample of all entries, which are put in the order of the blocks.
/// For choose(). Glossy ones are the first of a block.
void deal_blocks(LightStore& store);
/// Makes blocks of neighbours: entry i in block i / width, at i % width. For expect_all(), choose_some() and learn().
void lay_blocks(LightStore& store);
/// Adds all of another store, before the blocks are made.
void append(LightStore& store, const LightStore& more);
/// What entries of a store would bring to one camera vertex.
struct Expectation {
  std::vector<LightStore::Values> values;  ///< per block
  std::vector<LightStore::Sums> sums;      ///< of them
  float sum = 0;
};
/// After deal_blocks: draws from the entries of some blocks in proportion to what they would bring unoccluded times the
/// chance that they are seen (resampling: Talbot et al. 2005), evenly spaced over their sums: the more of the pixel's
/// light is expected, the more, in the mean a tenth to 32 (J3). Takes one pair of numbers. expected: storage.
void choose(const LightStore& store, const Joiner& joiner, Sampler& sampler, Expectation& expected,
            std::vector<StoreChoice>& out);

struct Visibility;
/// What is known of which entries a camera vertex sees: by what its tile saw of each in this pass, by the region that
/// it is in, or nothing, where all entries count in full.
struct Prospect {
  const Visibility* tile = nullptr;
  const Views* views = nullptr;
  uint32_t region = no_region;
};
/// After lay_blocks: of all entries. most: largest s.
void expect_all(const LightStore& store, const Vertex& camera, int most, const Prospect& known, Expectation& out);
/// Draws about `count` entries, each on its own (Poisson sampling), in proportion to what is expected of it and at most
/// once. key: random bits. Whether an entry is drawn depends on its chance and on a hash of key and light vertex alone:
/// as lights move a little, nearly all choices stay.
void choose_some(const LightStore& store, const Expectation& expected, int count, uint32_t key,
                 std::vector<StoreChoice>& out);

}  // namespace ajar
