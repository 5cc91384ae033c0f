// The archives of 3MF, which are unpacked by minizip, as assimp does.
#include <memory>
#include <minizip/unzip.h>
#include <stdexcept>

#include "collision/core/spelling.h"
#include "collision/geometry/assimp_content_xml.h"

namespace corridor {
namespace {

/// An unpacked file needs a multiple of its size; the largest is that of other mesh files.
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 30;

/// A file in the archive, and how many files have names with its end.
struct PackedFile {
  std::string name, bytes;
  int count = 0;
};

class Archive {
 public:
  explicit Archive(const std::string& file) : zip_(unzOpen(file.c_str()), unzClose) {
    if (!zip_) throw std::runtime_error("the file is no ZIP archive");
  }

  /// Returns the first file whose name has an end.
  PackedFile find(std::string_view end) {
    PackedFile found;
    for (int status = unzGoToFirstFile(zip_.get()); status == UNZ_OK;
         status = unzGoToNextFile(zip_.get())) {
      char name[65536];
      unz_file_info info;
      if (unzGetCurrentFileInfo(zip_.get(), &info, name, sizeof name, nullptr, 0, nullptr, 0) !=
          UNZ_OK)
        throw std::runtime_error("its directory is damaged");
      if (!lowered(std::string_view(name, info.size_filename)).ends_with(end)) continue;
      if (++found.count > 1) continue;
      found.name.assign(name, info.size_filename);
      found.bytes = unpacked(info.uncompressed_size);
    }
    return found;
  }

 private:
  std::string unpacked(std::size_t size) {
    if (size > kMostUnpackedBytes) throw std::runtime_error("its model has more than 1 GiB");
    std::string bytes(size, '\0');
    // One byte more than promised would be an error, too.
    char more = 0;
    if (unzOpenCurrentFile(zip_.get()) != UNZ_OK ||
        unzReadCurrentFile(zip_.get(), bytes.data(), static_cast<unsigned>(size)) !=
            static_cast<int>(size) ||
        unzReadCurrentFile(zip_.get(), &more, 1) != 0 || unzCloseCurrentFile(zip_.get()) != UNZ_OK)
      throw std::runtime_error("a file in it is damaged or encrypted");
    return bytes;
  }

  std::unique_ptr<void, int (*)(unzFile)> zip_;
};

/// Finds the model to which the archive's relations point. assimp reads the first one.
class RelationsCheck : public XmlCheck {
 public:
  using XmlCheck::XmlCheck;
  std::string target;

 private:
  void enter(const XmlTag& tag) override {
    constexpr std::string_view type =
        "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    if (tag.name == "Relationship" && tag.value("Type") == type && target.empty())
      target = tag.value("Target");
  }
};

constexpr XmlRules kRelations{"Relationships", "", "", "", "", ""};

void checkArchive(const std::string& file, ContentReport& report) {
  Archive archive(file);
  const PackedFile model = archive.find(".model");
  if (model.count > 1)
    return report.fault(file, 0,
                        "the archive has " + std::to_string(model.count) +
                            " models, of which assimp reads one" + kInstead);
  const PackedFile relations = archive.find("_rels/.rels");
  RelationsCheck check(kRelations, file, relations.bytes, report);
  check.run();
  const auto start = std::min(check.target.find_first_not_of('/'), check.target.size());
  if (model.count != 1 || relations.count != 1 || check.target.substr(start) != model.name)
    return report.fault(
        file, 0,
        "the archive's _rels/.rels must name its model, 3D/3dmodel.model" + std::string(kInstead));
  checkThreeMfModel(file + " (" + model.name + ")", model.bytes, report);
}

}  // namespace

void checkThreeMf(const std::string& file, ContentReport& report) {
  try {
    checkArchive(file, report);
  } catch (const std::runtime_error& error) {
    report.fault(file, 0, error.what() + std::string(kInstead));
  }
}

}  // namespace corridor
