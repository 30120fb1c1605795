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
  return scratch;
}

// Light vertices of a pool, about: no more than fill blocks that are all looked at. And how many chunks make one: the
// fewer, the less do pixels err together, but the more memory do they jump about in. (J10)
constexpr double pooled_lights = 1000;
constexpr uint32_t chunks_per_pool = 16;

// Chunks of which a thread traces one pool's samples after another's, so that what it reads of a pool is near; as few
// as keep all threads at work.
uint32_t chunks_of_a_group(uint32_t count, size_t threads) {
  return std::clamp(count / (4 * uint32_t(threads)), 1u, 4u);
}

void fill_pools(const Job& job, const Film& film, uint32_t from, Batch& batch) {
  std::vector<std::vector<const LightStore*>> stores(batch.pools.size());
  for (size_t i = 0; i < batch.halves.size(); ++i) stores[i % stores.size()].push_back(&batch.halves[i].store);
  parallel_for(uint32_t(stores.size()), [&](uint32_t k) {
    subsample(batch.pools[k], stores[k], pooled_lights, number_of(job, film, ~(from + k)));
    deal_blocks(batch.pools[k]);
  });
}

void gather_photons(const Job& job, Batch& batch) {
  std::vector<const Photons*> photons, few;
  for (const Halves& h : batch.halves) photons.push_back(&h.photons), few.push_back(&h.few);
  fill(batch.photons.all, job.walk.merging, photons);
  if (job.walk.counts.merge_inner > 0) fill(batch.photons.few, job.walk.merging, few);
}

}  // namespace

void start(Batch& batch, uint32_t count, bool in_halves) {
  if (!in_halves) batch.halves.clear(), batch.pools.clear();
  batch.splats.resize(count), batch.strategies.resize(count), batch.rejected_at.resize(count);
  batch.ledgers.assign(count, {});
  for (uint32_t i = 0; i < count; ++i) batch.splats[i].clear(), batch.strategies[i].clear();
}

void trace_in_halves(const Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches) {
  const uint32_t count = uint32_t(batch.splats.size());
  const auto at_work = [&](uint32_t i) -> Scratch& { return prepare(job, batch, i, scratches[thread_slot()]); };
  batch.halves.resize(count);
  batch.pools.resize(std::max(count / chunks_per_pool, 1u));
  const double kept = 2 * pooled_lights * double(batch.pools.size()) / count;
  parallel_for(count, [&](uint32_t i) {
    Scratch& scratch = at_work(i);
    begin_samples(job, film, from + i, scratch);
    trace_light_halves(job, film, from + i, kept, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  });
  fill_pools(job, film, from, batch);
  Job lit = job;  // with what there is to merge
  if (job.walk.merging.paths > 0) gather_photons(job, batch), lit.photons = &batch.photons;
  const auto trace_part = [&](uint32_t i, uint32_t pool) {
    Scratch& scratch = at_work(i);
    scratch.rejected_at = batch.rejected_at[i];
    scratch.pool = &batch.pools[pool];
    trace_camera_halves(lit, film, {pool, uint32_t(batch.pools.size())}, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  };
  const uint32_t group = chunks_of_a_group(count, scratches.size());
  parallel_for((count + group - 1) / group, [&](uint32_t g) {
    for (uint32_t pool = 0; pool < batch.pools.size(); ++pool)
      for (uint32_t i = g * group; i < std::min((g + 1) * group, count); ++i) trace_part(i, pool);
  });
}

void trace_whole(const Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches) {
  parallel_for(uint32_t(batch.splats.size()), [&](uint32_t i) {
    Scratch& scratch = prepare(job, batch, i, scratches[thread_slot()]);
    begin_samples(job, film, from + i, scratch);
    scratch.pool = nullptr;
    trace_camera_halves(job, film, {}, scratch);
    batch.rejected_at[i] = scratch.rejected_at;
  });
}

}  // namespace ajar
