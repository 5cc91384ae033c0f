// Tests of the cache: what was kept is found unchanged, and a damaged file is never used.
#include "collision/core/file_cache.h"

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

using std::filesystem::path;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A result of all kinds of pieces.
struct Result {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> numbers;
  double value = 0;
  std::string text;

  bool operator==(const Result&) const = default;
};

Result resultOf(std::uint32_t seed) {
  Result result{{Vec3(seed, 0.1, -0.0), Vec3(1, 2, 3)}, {}, 0.1 * seed, "note"};
  for (std::uint32_t i = 0; i < 5; ++i) result.numbers.push_back(seed + i);
  return result;
}

class FileCacheTest : public testing::Test {
 protected:
  ~FileCacheTest() override { std::filesystem::remove_all(folder_); }

  static Digest keyOf(const FileCache& cache, std::uint32_t seed) {
    const std::array<Bytes, 1> inputs = {bytesOf(seed)};
    return cache.key("test", inputs);
  }
  static std::optional<Result> find(const FileCache& cache, std::uint32_t seed) {
    Result result;
    const bool found = cache.find(keyOf(cache, seed), [&](CacheFileReader& reader) {
      reader.take(result.points);
      reader.take(result.numbers);
      reader.take(result.value);
      reader.take(result.text);
    });
    return found ? std::optional(result) : std::nullopt;
  }
  static void offer(FileCache& cache, std::uint32_t seed) {
    cache.offer(keyOf(cache, seed), [result = resultOf(seed)](CacheFileWriter& writer) {
      writer.put(result.points);
      writer.put(result.numbers);
      writer.put(result.value);
      writer.put(result.text);
    });
  }
  static void keep(FileCache& cache, std::uint32_t seed) {
    offer(cache, seed);
    cache.save();
  }
  std::vector<path> files() const {
    std::vector<path> all;
    for (const auto& entry : std::filesystem::directory_iterator(own_)) all.push_back(entry.path());
    return all;
  }
  static void write(const path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }

  path folder_ = newFolder();
  path own_ = folder_ / "caches" / "own";  // not there yet
};

TEST_F(FileCacheTest, FindsInAnotherObjectWhatWasSaved) {
  FileCache first(own_, "code");
  EXPECT_EQ(find(first, 1), std::nullopt);
  offer(first, 1);
  EXPECT_EQ(find(first, 1), std::nullopt) << "not saved yet";
  first.save();
  EXPECT_EQ(find(first, 1), resultOf(1));
  const FileCache second(own_, "code");
  EXPECT_EQ(find(second, 1), resultOf(1));
  EXPECT_EQ(find(second, 2), std::nullopt);
  EXPECT_EQ(second.counts().found, 1u);
  EXPECT_EQ(second.counts().missed, 1u);
  EXPECT_EQ(first.counts().written, 1u);
  EXPECT_THAT(first.takeNotes(), IsEmpty());
  EXPECT_EQ(std::filesystem::status(own_).permissions(), std::filesystem::perms::owner_all);
}

TEST_F(FileCacheTest, KeysDependOnCodeKindAndInputs) {
  const FileCache cache(own_, "code");
  const std::uint32_t one = 1;
  const std::array<Bytes, 1> inputs = {bytesOf(one)};
  EXPECT_EQ(cache.key("a", inputs), FileCache(folder_, "code").key("a", inputs));
  EXPECT_NE(cache.key("a", inputs), FileCache(own_, "other").key("a", inputs));
  EXPECT_NE(cache.key("a", inputs), cache.key("b", inputs));
  EXPECT_NE(cache.key("a", inputs), cache.key("a", {}));
}

TEST_F(FileCacheTest, NeverUsesAFileWithAFlippedByte) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const path file = files().at(0);
  const std::string bytes = contents(file);
  ASSERT_GT(bytes.size(), 100u);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const unsigned flip : {0x01U, 0x80U, 0xffU}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ flip);
      write(file, damaged);
      EXPECT_EQ(find(cache, 1), std::nullopt) << "byte " << i;
    }
  EXPECT_EQ(cache.counts().damaged, 3 * bytes.size());
  EXPECT_FALSE(std::filesystem::exists(file)) << "a damaged file is removed";
  EXPECT_THAT(
      cache.takeNotes(),
      ElementsAre("in the cache " + own_.string() + ", " + std::to_string(3 * bytes.size()) +
                  " files had damaged contents, which are not used (the first: \"" +
                  file.filename().string() + "\")"));
  EXPECT_THAT(cache.takeNotes(), IsEmpty()) << "each note is given once";
  keep(cache, 1);
  EXPECT_EQ(find(cache, 1), resultOf(1));
}

TEST_F(FileCacheTest, NeverUsesAFileOfAnotherLengthOrKey) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const path file = files().at(0);
  const std::string bytes = contents(file);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write(file, bytes.substr(0, size));
    EXPECT_EQ(find(cache, 1), std::nullopt) << size;
  }
  write(file, bytes + '\0');
  EXPECT_EQ(find(cache, 1), std::nullopt);
  write(file, bytes);
  EXPECT_EQ(find(cache, 1), resultOf(1));
  keep(cache, 2);
  const std::vector<path> both = files();
  write(both[0], contents(both[1]));  // one of them has the bytes of the other
  EXPECT_NE(find(cache, 1).has_value(), find(cache, 2).has_value());
}

TEST_F(FileCacheTest, AReaderThatAsksForOtherPiecesFindsNothing) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const auto asks = [&](const std::function<void(CacheFileReader&)>& take) {
    return cache.find(keyOf(cache, 1), take);
  };
  std::vector<Vec3> points;
  std::vector<std::uint32_t> numbers;
  double value = 0;
  std::string text, more;
  EXPECT_FALSE(asks([&](CacheFileReader& r) { r.take(points); })) << "pieces are left";
  EXPECT_FALSE(asks([&](CacheFileReader& r) { r.take(value); })) << "the first is a list";
  EXPECT_FALSE(asks([&](CacheFileReader& r) {
    r.take(points);
    r.take(points);  // 20 bytes are no list of vectors
    r.take(value);
    r.take(text);
  }));
  EXPECT_FALSE(asks([&](CacheFileReader& r) {
    r.take(points);
    r.take(numbers);
    r.take(value);
    r.take(text);
    r.take(more);
  })) << "there is no fifth piece";
}

TEST_F(FileCacheTest, DoesNotUseAFolderThatOthersMayWriteTo) {
  FileCache before(own_, "code");
  keep(before, 1);
  for (const mode_t mode : {0770, 0707}) {
    ASSERT_EQ(::chmod(own_.c_str(), mode), 0);
    FileCache cache(own_, "code");
    EXPECT_EQ(cache.whyUnusable(), "the cache in " + own_.string() +
                                       " is not used: other users may write to it (chmod go-w "
                                       "changes that)");
    EXPECT_EQ(find(cache, 1), std::nullopt);
    keep(cache, 2);
    EXPECT_EQ(files().size(), 1u);
    EXPECT_THAT(cache.takeNotes(), ElementsAre(cache.whyUnusable()));
    EXPECT_THAT(cache.takeNotes(), IsEmpty());
  }
  write(folder_ / "file", "x");
  EXPECT_THAT(FileCache(folder_ / "file", "code").whyUnusable(), HasSubstr("it is not a folder"));
  std::filesystem::create_symlink(folder_ / "nothing", folder_ / "link");
  EXPECT_THAT(FileCache(folder_ / "link", "code").whyUnusable(), HasSubstr("a link to nothing"));
}

TEST_F(FileCacheTest, SaysWhyItCantBeWritten) {
  const path nowhere = "/proc/none/cache";  // no folder can be made there
  FileCache cache(nowhere, "code");
  offer(cache, 1);
  keep(cache, 2);
  EXPECT_THAT(
      cache.takeNotes(),
      ElementsAre(
          "in the cache " + nowhere.string() +
          ", 2 files could not be written (the first: the folder can't be made: No such file or "
          "directory)"));
  EXPECT_EQ(cache.counts().written, 0u);
  EXPECT_EQ(cache.counts().failed, 2u);
}

TEST_F(FileCacheTest, AFileThatCantBeWrittenDoesNotKeepOthersFromIt) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const path file = files().at(0);
  std::filesystem::remove(file);
  std::filesystem::create_directories(file / "something");
  EXPECT_EQ(find(cache, 1), std::nullopt);
  EXPECT_THAT(cache.takeNotes(), testing::SizeIs(2)) << "damaged, and can't be removed";
  offer(cache, 1);
  keep(cache, 2);
  EXPECT_EQ(find(cache, 2), resultOf(2));
  EXPECT_THAT(cache.takeNotes(),
              ElementsAre(testing::StartsWith("in the cache " + own_.string() +
                                              ", 1 file could not be written (\"" +
                                              file.filename().string() + "\": ")));
}

TEST_F(FileCacheTest, DoesNotKeepAResultThatWouldPushOutTheOthers) {
  FileCache cache(own_, "code", 20'000);
  keep(cache, 1);
  const auto offerOf = [&](std::size_t size) {
    const std::array<Bytes, 1> inputs = {bytesOf(size)};
    const Digest key = cache.key("large", inputs);
    cache.offer(key, [size](CacheFileWriter& writer) { writer.put(std::string(size, 'x')); });
    cache.save();
    return cache.find(key, [](CacheFileReader& reader) {
      std::string text;
      reader.take(text);
    });
  };
  EXPECT_TRUE(offerOf(10'000));
  EXPECT_FALSE(offerOf(10'001));
  EXPECT_EQ(find(cache, 1), resultOf(1));
  EXPECT_THAT(cache.takeNotes(), IsEmpty());
}

TEST_F(FileCacheTest, TestsAFolderThatSomebodyElseMade) {
  FileCache cache(own_, "code");
  std::filesystem::create_directories(own_);
  ASSERT_EQ(::chmod(own_.c_str(), 0777), 0);
  keep(cache, 1);
  EXPECT_THAT(cache.takeNotes(), ElementsAre(HasSubstr("other users may write to it")));
  EXPECT_TRUE(files().empty());
}

TEST_F(FileCacheTest, APipeInPlaceOfAFileIsNotWaitedFor) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const path file = files().at(0);
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(find(cache, 1), std::nullopt);
  keep(cache, 1);
  EXPECT_EQ(find(cache, 1), resultOf(1)) << "the pipe is replaced";
}

TEST_F(FileCacheTest, RemovesTheFilesThatWereNotUsedForLongest) {
  FileCache cache(own_, "code");
  keep(cache, 1);
  const auto size = std::filesystem::file_size(files().at(0));
  const auto fileOf = [&](std::uint32_t seed) {
    FileCache other(folder_ / "other", "code");
    keep(other, seed);
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "other")) {
      const path found = own_ / entry.path().filename();
      std::filesystem::remove(entry.path());
      return found;
    }
    return path();
  };
  const auto longAgo = std::filesystem::file_time_type::clock::now() - std::chrono::hours(48);
  for (std::uint32_t seed = 2; seed < 5; ++seed) keep(cache, seed);
  for (std::uint32_t seed = 1; seed < 5; ++seed)
    std::filesystem::last_write_time(fileOf(seed), longAgo - std::chrono::hours(seed));
  EXPECT_EQ(find(cache, 4), resultOf(4)) << "the oldest, which is used now";
  write(own_ / ".corridor1.tmp", "a draft of a program that was killed");
  std::filesystem::last_write_time(own_ / ".corridor1.tmp", longAgo);
  write(own_ / ".corridor2.tmp", "a draft of a program that runs");
  const std::vector<std::string> foreign = {"others.cache", "others.tmp",
                                            "0123456789ABCDEF0123456789ABCDEF.cache"};
  for (const std::string& name : foreign) {
    write(own_ / name, std::string(10 * size, 'x'));
    std::filesystem::last_write_time(own_ / name, longAgo - std::chrono::hours(24));
  }
  FileCache small(own_, "code", 3 * size);
  keep(small, 5);
  EXPECT_EQ(find(small, 3), std::nullopt);
  EXPECT_EQ(find(small, 2), std::nullopt);
  for (const std::uint32_t seed : {1U, 4U, 5U}) EXPECT_EQ(find(small, seed), resultOf(seed));
  EXPECT_FALSE(std::filesystem::exists(own_ / ".corridor1.tmp"));
  EXPECT_TRUE(std::filesystem::exists(own_ / ".corridor2.tmp"));
  EXPECT_EQ(small.size().files, 3u);
  EXPECT_EQ(small.size().bytes, 3 * size);
  EXPECT_EQ(small.clear(), 3u);
  EXPECT_EQ(small.size().files, 0u);
  EXPECT_FALSE(std::filesystem::exists(own_ / ".corridor2.tmp"));
  for (const std::string& name : foreign)
    EXPECT_EQ(contents(own_ / name).size(), 10 * size) << "not a file of the cache";
}

// Many caches of one folder, as of many programs.
TEST_F(FileCacheTest, ManyWritersAndReadersNeverSeePartOfAFile) {
  std::atomic<int> wrong = 0, found = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      std::mt19937 random(static_cast<unsigned>(t));
      for (int i = 0; i < 100 / kSlowdown + 10; ++i) {
        FileCache cache(own_, "code");
        const auto seed = static_cast<std::uint32_t>(random() % 4);
        if (const auto result = find(cache, seed)) {
          ++found;
          wrong += *result != resultOf(seed);
        }
        wrong += static_cast<int>(cache.counts().damaged);
        keep(cache, seed);
        wrong += !cache.takeNotes().empty();
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(found, 0);
  EXPECT_EQ(files().size(), 4u);
}

}  // namespace
}  // namespace corridor::test
