// Light vertices that many tiles share: pools to join, and photon maps.

#include "batch.h"

#include "ajar/core/parallel.h"
#include "ajar/join/pool.h"
#include "chunk.h"

namespace ajar {
namespace {

// Lends a thread's scratch to a chunk of the batch.
Scratch& prepare(const Job& job, Batch& batch, uint32_t i, Scratch& scratch) {
  scratch.splats = &batch.splats[i];
  scratch.ledger = &batch.ledgers[i];
  scratch.strategies = job.techniques ? &batch.strategies[i] : nullptr;
  scratch.halves = batch.halves.empty() ? &scratch.own_halves : &batch.halves[i];
  scratch.pool = batch.pools.empty() ? nullptr : &batch.pools[batch.pool_of[i]];
  return scratch;
}

// Light vertices of a pool, about: no more than fill blocks that are all looked at. And how many chunks make one: what
// few lights shine on is streaked in the same way in all chunks that share them, so neighbours rarely do.
constexpr double pooled_lights = 1000;
constexpr uint32_t chunks_per_pool = 32;

// Which pool a chunk gives its light vertices to, and takes others from.
void assign_pools(const Job& job, const Film& film, uint32_t from, Batch& batch) {
  const uint32_t count = uint32_t(batch.halves.size()), pools = std::max(count / chunks_per_pool, 1u);
  batch.pools.resize(pools), batch.pool_of.resize(count);
  for (uint32_t i = 0; i < count; ++i)
    batch.pool_of[i] = uint32_t(hash(hash(job.seed, 0x3f0d), hash(film.dropped + film.passes, from + i)) % pools);
}

void fill_pools(const Job& job, const Film& film, uint32_t from, Batch& batch) {
  std::vector<std::vector<const LightStore*>> stores(batch.pools.size());
  for (size_t i = 0; i < batch.halves.size(); ++i) stores[batch.pool_of[i]].push_back(&batch.halves[i].store);
  parallel_for(uint32_t(stores.size()), [&](uint32_t k) {
    keep(batch.pools[k], stores[k], pooled_lights, number_of(job, film, ~(from + k)));
    finish(batch.pools[k]);
  });
}

void gather_photons(Job& job, Batch& batch) {
  if (!(job.walk.merging.paths > 0)) return;
  std::vector<const Photons*> photons, few;
  for (const Halves& h : batch.halves) photons.push_back(&h.photons), few.push_back(&h.few);
  fill(batch.photons[0], job.walk.merging, photons);
  if (job.walk.merging.inner > 0) fill(batch.photons[1], job.walk.merging, few);
  job.photons = batch.photons;
}

}  // namespace

void start(Batch& batch, uint32_t count, bool in_halves) {
  if (!in_halves) batch.halves.clear(), batch.pools.clear();
  batch.splats.resize(count), batch.strategies.resize(count), batch.rejected_at.resize(count);
  batch.ledgers.assign(count, {});
  for (uint32_t i = 0; i < count; ++i) batch.splats[i].clear(), batch.strategies[i].clear();
}

void trace_in_halves(Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches) {
  const uint32_t count = uint32_t(batch.splats.size());
  const auto at_work = [&](uint32_t i) -> Scratch& { return prepare(job, batch, i, scratches[thread_slot()]); };
  batch.halves.resize(count);
  assign_pools(job, film, from, batch);
  job.kept = 2 * pooled_lights * double(batch.pools.size()) / count;
  parallel_for(count, [&](uint32_t i) {
    Scratch& scratch = at_work(i);
    trace_light_halves(job, film, from + i, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  });
  fill_pools(job, film, from, batch);
  gather_photons(job, batch);
  parallel_for(count, [&](uint32_t i) {
    Scratch& scratch = at_work(i);
    scratch.rejected_at = batch.rejected_at[i];
    trace_camera_halves(job, film, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  });
}

void trace_whole(const Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches) {
  parallel_for(uint32_t(batch.splats.size()), [&](uint32_t i) {
    Scratch& scratch = prepare(job, batch, i, scratches[thread_slot()]);
    trace_light_halves(job, film, from + i, scratch);
    trace_camera_halves(job, film, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  });
}

}  // namespace ajar
