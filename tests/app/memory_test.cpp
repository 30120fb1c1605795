// The program's own operator new, which this program is made with, too.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace ajar {
namespace {

constexpr size_t large_page = size_t(2) << 20;

// What the system was told of the mapping that holds an address: the line "VmFlags" of it.
std::string flags_of(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  const auto wanted = reinterpret_cast<uintptr_t>(address);
  bool within = false;
  for (std::string line; std::getline(maps, line);) {
    uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::istringstream words(line);
    if (words >> std::hex >> begin >> dash >> end && dash == '-') within = begin <= wanted && wanted < end;
    if (within && line.rfind("VmFlags:", 0) == 0) return line + " ";
  }
  return "";
}

TEST(Memory, LargeBlocksAskForLargePages) {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage/enabled"))
    GTEST_SKIP() << "this system has no large pages to give";
  for (const size_t bytes : {2 * large_page, 5 * large_page + 12345}) {
    const auto block = std::make_unique<std::byte[]>(bytes);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(block.get()) % large_page, 0u);
    EXPECT_NE(flags_of(block.get()).find(" hg "), std::string::npos) << flags_of(block.get());
  }
}

TEST(Memory, BlocksOfEverySizeAreWhole) {
  std::vector<std::vector<uint32_t>> blocks;
  for (const size_t bytes :
       {size_t(0), size_t(4), size_t(4096), 2 * large_page - 4, 2 * large_page, 3 * large_page + 4}) {
    blocks.emplace_back(bytes / 4);
    std::iota(blocks.back().begin(), blocks.back().end(), uint32_t(bytes));
  }
  for (const auto& block : blocks)
    for (size_t i = 1; i < block.size(); ++i) ASSERT_EQ(block[i], block[0] + i);
}

TEST(Memory, WhatThereIsNotThrows) {
  volatile size_t most = size_t(1) << 62;
  EXPECT_THROW(static_cast<void>(std::make_unique<std::byte[]>(most)), std::bad_alloc);
}

}  // namespace
}  // namespace ajar
