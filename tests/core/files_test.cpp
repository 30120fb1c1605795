// Files that are written aside: whether they can be is known before, and leaves no trace.
#include "ajar/core/files.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "kit/files.h"

namespace {
bool out_of_streams = false;
}

// In the place of the C library's.
extern "C" std::FILE* fdopen(int descriptor, const char* mode) noexcept {
  if (out_of_streams) {
    errno = ENOMEM;
    return nullptr;
  }
  return reinterpret_cast<decltype(&fdopen)>(::dlsym(RTLD_NEXT, "fdopen"))(descriptor, mode);
}

namespace ajar {
namespace {

namespace fs = std::filesystem;
using kit::error_of;

struct Files : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("ajar_files" + std::to_string(::getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }

  std::string file(const std::string& name) const { return (folder / name).string(); }
  size_t count() const { return size_t(std::distance(fs::directory_iterator(folder), {})); }
  static std::string checked(const std::string& path) {
    return error_of([&] { check_file(path); });
  }
};

TEST_F(Files, TryingLeavesThingsAsTheyWere) {
  write_text(file("a"), "old");
  EXPECT_EQ(checked(file("a")), "");
  EXPECT_EQ(checked(file("b")), "");
  EXPECT_EQ(kit::bytes_of(file("a")), "old");
  EXPECT_EQ(count(), 1u);
}

TEST_F(Files, WhatCannotBeWrittenIsKnownBefore) {
  EXPECT_NE(checked(file(std::string(300, 'a') + "/a")).find("shorter name"), std::string::npos);
  EXPECT_NE(checked(file("none/" + std::string(300, 'a'))).find("shorter name"), std::string::npos);
  EXPECT_NE(checked(folder.string()).find("name a file"), std::string::npos);
  EXPECT_NE(checked(file("")).find("name a file"), std::string::npos);
  EXPECT_NE(checked(file(std::string(300, 'a'))).find("shorter name"), std::string::npos);
  EXPECT_NE(checked("").find("empty"), std::string::npos);
  // Of a file system that nobody writes to, not even root.
  EXPECT_NE(checked("/proc/ajar"), "");
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, PipesAreNoFilesToTry) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(checked(file("pipe")), "");
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
}

TEST_F(Files, FoldersAreTriedWhereTheyWillBe) {
  const auto said = [&](const std::string& path) { return error_of([&] { check_folder(path); }); };
  EXPECT_EQ(said(folder.string()), "");
  EXPECT_EQ(said(file("a/b/")), "");
  EXPECT_EQ(count(), 0u);
  write_text(file("text"), "");
  EXPECT_NE(said(file("text")).find("cannot be written"), std::string::npos);
  EXPECT_NE(said(file("text/a")).find("cannot be written"), std::string::npos);
  EXPECT_NE(said("/proc/ajar/b"), "");
}

// Two of one name at once, in one process or with the same number on two machines.
TEST_F(Files, TemporaryOnesAreNobodyElses) {
  write_aside(file("a"), [&](Sink& outer) {
    write_text(file("a"), "inner");
    EXPECT_EQ(kit::bytes_of(file("a")), "inner");
    outer.bytes("outer", 5);
  });
  EXPECT_EQ(kit::bytes_of(file("a")), "outer");
  EXPECT_EQ(count(), 1u);
  EXPECT_NE(temporary_suffix(), temporary_suffix());
}

TEST_F(Files, LinksAreFollowedWhetherTheirFilesAreThereOrNot) {
  fs::create_directories(folder / "far");
  fs::create_symlink("far/b", file("a"));
  fs::create_symlink("a", file("c"));
  EXPECT_EQ(checked(file("c")), "");
  write_text(file("c"), "text");
  EXPECT_TRUE(fs::is_symlink(file("a")) && fs::is_symlink(file("c")));
  EXPECT_EQ(kit::bytes_of(file("far/b")), "text");
  EXPECT_EQ(target_of(file("c")), target_of(file("far/b")));
  fs::create_symlink("none/b", file("d"));
  EXPECT_EQ(checked(file("d")), "");
  EXPECT_EQ(target_of(file("d")), file("none/b"));
  write_text(file("d"), "text");
  EXPECT_EQ(kit::bytes_of(file("none/b")), "text");
  fs::create_symlink("e", file("e"));
  EXPECT_NE(checked(file("e")).find("cannot be written"), std::string::npos);
}

TEST_F(Files, ReplacedOnesLeaveTheirPermissions) {
  write_text(file("a"), "old");
  for (const auto mode : {fs::perms(0600), fs::perms(0666), fs::perms(0440)}) {
    fs::permissions(file("a"), mode);
    write_text(file("a"), "new");
    EXPECT_EQ(fs::status(file("a")).permissions(), mode);
  }
}

TEST_F(Files, FoldersAreMadeWhereTheyAreWrittenTo) {
  EXPECT_EQ(checked(file("a/b/c")), "");
  EXPECT_EQ(count(), 0u) << "tried alone";
  write_text(file("a/b/c"), "text");
  EXPECT_EQ(kit::bytes_of(file("a/b/c")), "text");
  write_text(file("text"), "text");
  for (const std::string& in_a_file : {file("text/a"), file("text/a/b")}) {
    EXPECT_NE(checked(in_a_file).find(in_a_file + ": cannot be written (Not a directory); name another folder"),
              std::string::npos);
    EXPECT_NE(error_of([&] { write_text(in_a_file, ""); }).find(in_a_file + ": cannot be written"), std::string::npos);
  }
}

TEST_F(Files, OfAFolderAreInOrder) {
  for (const char* name : {"b", "a", "c"}) write_text(file(name), "");
  EXPECT_EQ(files_in(folder.string()), (std::vector<fs::path>{file("a"), file("b"), file("c")}));
  EXPECT_TRUE(files_in(file("none")).empty());
  EXPECT_TRUE(files_in(file("a")).empty());
}

TEST_F(Files, AStreamThatCannotBeOpenedIsAnError) {
  out_of_streams = true;
  const std::string said = error_of([&] { write_text(file("a"), "text"); });
  out_of_streams = false;
  EXPECT_NE(said.find("a: cannot be written (Cannot allocate memory)"), std::string::npos) << said;
  EXPECT_EQ(count(), 0u);
}

TEST_F(Files, WhoCannotSayWhatToWriteWritesNothing) {
  write_text(file("a"), "old");
  EXPECT_THROW(write_aside(file("a"), [](Sink&) { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(kit::bytes_of(file("a")), "old");
  EXPECT_EQ(count(), 1u);
}

}  // namespace
}  // namespace ajar
