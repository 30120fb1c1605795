// Runs a libFuzzer entry point without libFuzzer: every file of a corpus, and mutations of it drawn from a fixed seed.
// usage: fuzz_NAME CORPUS_FOLDER MUTATIONS_PER_FILE. The input at hand is kept in fuzz_NAME.input: after a crash, the
// culprit.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "ajar/core/sampler.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

using Bytes = std::vector<uint8_t>;

struct Random {
  uint64_t state;
  uint64_t below(uint64_t n) { return n == 0 ? 0 : (state = ajar::mix64(state)) % n; }
};

Bytes read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void copy_piece(Bytes& bytes, const Bytes& from, Random& random) {
  const size_t begin = random.below(from.size()), length = random.below(std::min<size_t>(from.size() - begin, 256)) + 1;
  const Bytes piece(from.begin() + long(begin), from.begin() + long(std::min(begin + length, from.size())));
  bytes.insert(bytes.begin() + long(random.below(bytes.size() + 1)), piece.begin(), piece.end());
}

// One small wound: a flipped bit, an interesting byte, a piece cut out, repeated or taken from another file, the end
// cut off.
void mutate(Bytes& bytes, const Bytes& other, Random& random) {
  static constexpr uint8_t interesting[] = {0,   0xff, 0x7f, 0x80, '<', '>', '"', '\'',
                                            '&', '$',  '-',  '.',  'e', '9', ' ', '\n'};
  if (bytes.empty()) return copy_piece(bytes, other.empty() ? Bytes{'<'} : other, random);
  const size_t at = random.below(bytes.size());
  switch (random.below(6)) {
    case 0:
      bytes[at] ^= uint8_t(1u << random.below(8));
      break;
    case 1:
      bytes[at] = interesting[random.below(std::size(interesting))];
      break;
    case 2:
      bytes.erase(bytes.begin() + long(at), bytes.begin() + long(std::min(bytes.size(), at + 1 + random.below(64))));
      break;
    case 3:
      copy_piece(bytes, Bytes(bytes), random);
      break;
    case 4:
      copy_piece(bytes, other.empty() ? bytes : other, random);
      break;
    default:
      bytes.resize(at);
      break;
  }
}

void run(const Bytes& bytes, const std::string& kept) {
  std::ofstream(kept, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: %s CORPUS_FOLDER MUTATIONS_PER_FILE\n", argv[0]), 2;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[1]))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) return std::fprintf(stderr, "%s holds no files\n", argv[1]), 2;

  std::vector<Bytes> corpus;
  for (const auto& file : files) corpus.push_back(read(file));
  const std::string kept = std::filesystem::path(argv[0]).filename().string() + ".input";
  const int mutations = std::atoi(argv[2]);
  Random random{1};
  for (const Bytes& original : corpus) {
    run(original, kept);
    for (int i = 0; i < mutations; ++i) {
      Bytes bytes = original;
      for (uint64_t n = 1 + random.below(4); n > 0; --n) mutate(bytes, corpus[random.below(corpus.size())], random);
      run(bytes, kept);
    }
  }
  std::filesystem::remove(kept);
  std::printf("%zu files, %d mutations of each\n", corpus.size(), mutations);
  return 0;
}
