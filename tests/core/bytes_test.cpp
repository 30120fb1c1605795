// Files of bytes: the same back, and nothing but an Error from a damaged one.
#include "ajar/core/bytes.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "ajar/core/error.h"
#include "kit/files.h"

namespace ajar {
namespace {

constexpr FileKind kind = {"TESTab01", "list", "write one", "write it again"};

struct Bytes : testing::Test {
  std::string path = (std::filesystem::path(testing::TempDir()) / ("ajar_bytes" + std::to_string(::getpid()))).string();
  void TearDown() override { std::filesystem::remove(path); }

  void write() const {
    write_file(path, kind, [](Writer& w) {
      w.text("words");
      w.value(1.5);
      w.array(std::vector<int>{3, 1, 4, 1, 5});
      w.array(std::vector<int>{});
    });
  }
  std::vector<int> read(const FileKind& as = kind) const {
    Reader r(path, as);
    std::string text;
    double number = 0;
    std::vector<int> list, empty{7};
    r.text(text), r.value(number), r.array(list), r.array(empty);
    r.finish();
    EXPECT_EQ(text, "words");
    EXPECT_EQ(number, 1.5);
    EXPECT_TRUE(empty.empty());
    return list;
  }
};

TEST(Keys, DifferInParts) {
  EXPECT_EQ(difference("1,box.xml,sum 12,seed 1", "1,box.xml,sum 13,seed 1"), "there sum 12, here sum 13");
  EXPECT_EQ(difference("1,a,b,c", "1,x,b,y"), "there a,b,c, here x,b,y");
  EXPECT_EQ(difference("ab", "b"), "there ab, here b");
  EXPECT_EQ(difference("{a,b}", "{a,c}"), "there b, here c");
  EXPECT_EQ(difference("{a,b}", "{a,b,c}"), "there b, here b,c");
  EXPECT_EQ(difference("a\x1b"
                       "\x01"
                       "b",
                       "b"),
            "there a??b, here b");
}

TEST_F(Bytes, ComeBack) {
  write();
  EXPECT_EQ(read(), (std::vector{3, 1, 4, 1, 5}));
}

TEST_F(Bytes, AnyChangedBitIsAnError) {
  write();
  const auto size = std::filesystem::file_size(path);
  for (size_t at = 0; at < size; ++at) {
    write();
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(std::streamoff(at));
    const char was = char(file.get());
    file.seekp(std::streamoff(at));
    file.put(char(was ^ (1 << (at % 8))));
    file.close();
    EXPECT_THROW(read(), Error) << at;
  }
}

TEST_F(Bytes, TooShortOrTooLongIsAnError) {
  write();
  const auto size = std::filesystem::file_size(path);
  for (size_t length = 0; length < size; ++length) {
    write();
    std::filesystem::resize_file(path, length);
    EXPECT_THROW(read(), Error) << length;
  }
  write();
  std::filesystem::resize_file(path, size + 8);
  EXPECT_THROW(read(), Error);
}

TEST_F(Bytes, ErrorsNameFileKindAndCure) {
  write();
  const auto message = [&](const FileKind& as) -> std::string {
    try {
      read(as);
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  };
  const FileKind other = {"TESTab02", "list", "write one", "write it again"};
  EXPECT_EQ(message(other), path + ": not a list of this version of ajar; write it again");
  std::filesystem::resize_file(path, 20);
  EXPECT_EQ(message(kind), path + ": list is damaged; write it again");
  std::filesystem::remove(path);
  EXPECT_EQ(message(kind), path + ": no such list; write one");
}

TEST_F(Bytes, WhatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  write();
  EXPECT_THROW(write_file(path + "/no/such", kind, [](Writer&) {}), Error) << "a file is in the way";
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);
  EXPECT_THROW(write(), Error) << "a folder is in the way";
  try {
    read();
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_EQ(e.what(), path + ": is a folder; name a list");
  }
}

TEST_F(Bytes, PipesAreNoLists) {
  path = "/dev/null";
  try {
    read();
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "/dev/null: is no regular file; copy this list to one");
  }
  path.clear();  // is not to be removed
}

// A full disk: what is there stays, and the message says why.
TEST_F(Bytes, TheCauseIsSaidAndTheOldFileStays) {
  write();
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error =
      kit::error_of([&] { write_file(path, kind, [](Writer& w) { w.array(std::vector<double>(10000)); }); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("free some space"), std::string::npos) << error;
  EXPECT_EQ(read(), (std::vector{3, 1, 4, 1, 5}));
}

TEST_F(Bytes, LinksStayAndLeadToTheNewFile) {
  const std::string link = path + "link";
  std::ofstream(path) << "old";
  std::filesystem::create_symlink(path, link);
  write_file(link, kind, [](Writer& w) { w.value(1.5); });
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_NE(kit::bytes_of(path), "old");
  std::filesystem::remove(link);
}

}  // namespace
}  // namespace ajar
