// Archives: what is in them arrives under numbers, tricks and damage are refused by name.
#include "core/source/zip.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zip.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/unit/source/reading.h"

namespace citymesh::source {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Entry {
  std::string name{};
  std::string text{};
  mode_t mode = S_IFREG;
  bool stored = false;
  bool encrypted = false;
};

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Zip : public ::testing::Test {
 protected:
  Zip() { std::filesystem::create_directory(out_); }

  void write(const std::vector<Entry>& entries) {
    zip_t* const zip = zip_open(archive_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    ASSERT_NE(zip, nullptr);
    for (const Entry& entry : entries) {
      zip_source_t* const source = zip_source_buffer(zip, entry.text.data(), entry.text.size(), 0);
      const zip_int64_t index = zip_file_add(zip, entry.name.c_str(), source, ZIP_FL_ENC_UTF_8);
      ASSERT_GE(index, 0) << zip_strerror(zip);
      const auto i = static_cast<zip_uint64_t>(index);
      zip_file_set_external_attributes(zip, i, 0, ZIP_OPSYS_UNIX, entry.mode << 16);
      if (entry.stored) zip_set_file_compression(zip, i, ZIP_CM_STORE, 0);
      if (entry.encrypted) zip_file_set_encryption(zip, i, ZIP_EM_TRAD_PKWARE, "secret");
    }
    ASSERT_EQ(zip_close(zip), 0);
  }

  /// Changes all occurrences: names stand in front of a member and in the directory.
  void replace(const std::string& from, const std::string& to) {
    std::string bytes = bytes_of(archive_);
    bool any = false;
    for (auto at = bytes.find(from); at != bytes.npos; at = bytes.find(from, at + 1)) {
      bytes.replace(at, from.size(), to);
      any = true;
    }
    ASSERT_TRUE(any);
    std::ofstream(archive_, std::ios::binary) << bytes;
  }

  Result<std::vector<ZipMember>> unpack(const ReadLimits& limits = {}) const {
    return unpack_zip(archive_, out_, limits);
  }

  /// Name and text of each, after checking that nothing lies outside of the folder.
  std::vector<std::string> unpacked() const {
    const auto members = unpack();
    if (!members) {
      ADD_FAILURE() << members.error().message;
      return {};
    }
    std::vector<std::string> all;
    for (const ZipMember& member : *members) {
      EXPECT_EQ(member.path.parent_path(), out_);
      all.push_back(member.name + "=" + bytes_of(member.path));
    }
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      if (!entry.is_directory()) ++files;
    }
    EXPECT_EQ(files, members->size() + 1) << "the members and the archive";
    return all;
  }

  Error refusal(const ReadLimits& limits = {}) const {
    const auto members = unpack(limits);
    EXPECT_FALSE(members);
    EXPECT_TRUE(std::filesystem::is_empty(out_)) << "nothing is left behind";
    return members ? Error{} : members.error();
  }

  TempFolder folder_{};
  std::filesystem::path archive_ = folder_ / "a.zip";
  std::filesystem::path out_ = folder_ / "out";
};

TEST_F(Zip, MembersAreSortedByName) {
  write({{"b.gml", "B"}, {"tiles/c.gml", "C"}, {"a.gml", "A"}});
  EXPECT_THAT(unpacked(), ElementsAre("a.gml=A", "b.gml=B", "tiles/c.gml=C"));
  EXPECT_TRUE(*is_zip(archive_));
  EXPECT_FALSE(*is_zip(out_ / "0"));
}

TEST_F(Zip, FoldersLinksHiddenFilesAndLitterArePassedOver) {
  write({{"a.gml", "A"},
         {"tiles/", ""},
         {"link.gml", "/etc/passwd", S_IFLNK},
         {"pipe", "", S_IFIFO},
         {"folder", "", S_IFDIR},
         {".hidden", "x"},
         {"tiles/.DS_Store", "x"},
         {"__MACOSX/tiles/._a.gml", "x"},
         {"tiles/Thumbs.db", "x"},
         {"plain", "P", 0}});
  EXPECT_THAT(unpacked(), ElementsAre("a.gml=A", "plain=P"));
}

TEST_F(Zip, NamesNeverBecomePaths) {
  write({{"../../up.gml", "1"},
         {"/tmp/absolute.gml", "2"},
         {"a/../../b.gml", "3"},
         {"C:\\evil.gml", "4"},
         {std::string(5000, 'x'), "5"}});
  EXPECT_THAT(unpacked(), ElementsAre("../../up.gml=1", "/tmp/absolute.gml=2", "C:\\evil.gml=4",
                                      "a/../../b.gml=3", std::string(5000, 'x') + "=5"));
}

TEST_F(Zip, NamesThatRepeatAreAllUnpacked) {
  write({{"a.gml", "1", S_IFREG, true}, {"b.gml", "2", S_IFREG, true}});
  replace("b.gml", "a.gml");
  EXPECT_THAT(unpacked(), ElementsAre("a.gml=1", "a.gml=2"));
}

TEST_F(Zip, ArchivesInArchivesStayPacked) {
  write({{"inner.gml", "I"}});
  const std::string inner = bytes_of(archive_);
  write({{"inner.zip", inner}});
  EXPECT_THAT(unpacked(), ElementsAre("inner.zip=" + inner));
}

TEST_F(Zip, EmptyArchivesHaveNoMembers) {
  std::ofstream(archive_, std::ios::binary) << std::string("PK\5\6", 4) + std::string(18, '\0');
  EXPECT_THAT(unpacked(), ElementsAre());
}

TEST_F(Zip, BombsAreRefused) {
  write({{"good.gml", "G"}, {"zeros.gml", std::string(40u << 20, '\0')}});
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::ResourceExhausted);
  EXPECT_THAT(error.message, HasSubstr("'zeros.gml'"));
}

TEST_F(Zip, SizeAndNumberOfMembersAreLimited) {
  write({{"a.gml", std::string(600, 'a')}, {"b.gml", std::string(600, 'b')}});
  ReadLimits limits;
  limits.max_file_bytes = 1000;
  EXPECT_THAT(refusal(limits).message, HasSubstr("max_file_bytes = 1000"));
}

TEST_F(Zip, EncryptedMembersAreNamed) {
  write({{"a.gml", "A"}, {"secret.gml", "S", S_IFREG, false, true}});
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::Unimplemented);
  EXPECT_THAT(error.message, HasSubstr("'secret.gml'"));
}

TEST_F(Zip, DamageIsFoundByChecksums) {
  write({{"a.gml", "A"}, {"b.gml", "the original", S_IFREG, true}});
  replace("original", "forgery!");
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::DataLoss);
  EXPECT_THAT(error.message, HasSubstr("'b.gml'"));
}

TEST_F(Zip, TruncatedArchivesAreDamaged) {
  write({{"a.gml", std::string(5000, 'a')}});
  std::filesystem::resize_file(archive_, std::filesystem::file_size(archive_) / 2);
  const Error error = refusal();
  EXPECT_EQ(error.code, ErrorCode::DataLoss);
  EXPECT_THAT(error.message, HasSubstr("damaged"));
}

TEST_F(Zip, MissingArchivesAndFoldersAreNamed) {
  EXPECT_EQ(refusal().code, ErrorCode::NotFound);
  write({{"a.gml", "A"}});
  const auto members = unpack_zip(archive_, folder_ / "none", {});
  ASSERT_FALSE(members);
  EXPECT_EQ(members.error().code, ErrorCode::FailedPrecondition);
}

TEST_F(Zip, EveryCityModelOfAnArchiveIsAnInput) {
  write({{"north/a.gml", city_model(simple_building("a", 0, 0))},
         {"notes.txt", "no city model"},
         {"south.gml", city_model(simple_building("b", 50, 0))}});
  auto source = open_files({archive_}, {});
  ASSERT_TRUE(source);
  const Reading reading = read_from(**source);
  EXPECT_THAT(reading.ids(), ElementsAre("a", "b"));
  EXPECT_EQ(reading.input(0).file, "a.zip/north/a.gml");
  EXPECT_EQ(reading.input(1).file, "a.zip/south.gml");
  EXPECT_THAT(reading.selection.warnings, ::testing::Contains(HasSubstr("notes.txt")));
  EXPECT_EQ(read_from(**source).ids(), reading.ids()) << "and again";
}

TEST_F(Zip, ADamagedArchiveIsAnInputThatCouldNotBeRead) {
  write({{"a.gml", "A"}, {"b.gml", "the original", S_IFREG, true}});
  replace("original", "forgery!");
  auto source = open_files({archive_}, {});
  ASSERT_TRUE(source);
  const Reading reading = read_from(**source);
  EXPECT_FALSE(reading.error);
  EXPECT_EQ(reading.input().state, "failed");
  EXPECT_THAT(reading.input().message, HasSubstr("'b.gml'"));
}

}  // namespace
}  // namespace citymesh::source
