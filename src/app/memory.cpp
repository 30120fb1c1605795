// Memory for the whole program: large blocks lie on large pages where the system has them for who asks (Linux, setting
// "madvise"). Scenes, images, fields and films are read at random: with small pages the processor looks up one address
// after another, and the system hands over half a thousand pages for one. Not in the library: memory is the business of
// the program that it is linked to.

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t large_page = std::size_t(2) << 20;

void* allocate(std::size_t bytes) noexcept {
  if (bytes < 2 * large_page) return std::malloc(bytes > 0 ? bytes : 1);
  void* block = nullptr;
  if (::posix_memalign(&block, large_page, bytes) != 0) return nullptr;
#ifdef MADV_HUGEPAGE
  ::madvise(block, bytes / large_page * large_page, MADV_HUGEPAGE);  // advice: without it the block is as good
#endif
  return block;
}

}  // namespace

// Not inline: g++ takes one that is and the other that is not for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  for (;;) {
    if (void* block = allocate(bytes)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}

[[gnu::noinline]] void operator delete(void* block) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept { std::free(block); }
