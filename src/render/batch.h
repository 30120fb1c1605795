// Enters: a job, and some tiles of the film's pass at hand.
// Leaves: what their samples found, tile by tile, in an order that does not depend on threads.
#pragma once

#include "job.h"
#include "merge.h"

namespace ajar {

/// Chunks that are traced at once, one after another in the film.
struct Batch {
  std::vector<std::vector<Splat>> splats;
  std::vector<std::vector<Strategy>> strategies;
  std::vector<Ledger> ledgers;
  std::vector<uint64_t> rejected_at;  ///< path of each chunk's first rejected value
  std::vector<Halves> halves;         ///< only where light subpaths of the whole batch are joined or merged
  std::vector<LightStore> pools;      ///< likewise; a sample's camera half reads one of them
  PhotonMaps photons;
};

/// Empties a batch, for so many chunks.
void start(Batch& batch, uint32_t count, bool in_halves);
/// Light halves of all chunks, then what is joined and merged with them: their number must not depend on threads or
/// clocks. from: the first chunk.
void trace_in_halves(const Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches);
/// Chunk by chunk.
void trace_whole(const Job& job, Film& film, uint32_t from, Batch& batch, std::vector<Scratch>& scratches);

}  // namespace ajar
