#include "collision/geometry/cached_mesh_file.h"

#include <array>
#include <cstdint>

namespace corridor {
namespace {

/// Below this size, finding a result takes as long as reading the file (measured: 0.1 ms).
constexpr std::size_t kLeastBytes = 16384;

/// The values of a `MeshFile` that are no lists and no texts, without padding.
struct Values {
  std::int32_t fileUp = 0;  // 0: none
  std::uint32_t isCollada = 0, facesOnly = 0, notes = 0, units = 0;
};
struct UnitValues {
  double metresPerUnit = 0;
  std::int64_t line = 0;
};

void put(const MeshFile& file, CacheFileWriter& writer) {
  writer.put(Values{.fileUp = file.fileUp.value_or(0),
                    .isCollada = file.isCollada,
                    .facesOnly = file.facesOnly,
                    .notes = static_cast<std::uint32_t>(file.notes.size()),
                    .units = static_cast<std::uint32_t>(file.statedUnits.size())});
  writer.put(file.mesh.vertices);
  writer.put(file.mesh.triangles);
  writer.put(file.format);
  writer.put(file.unitRule);
  writer.put(file.upRule);
  for (const std::string& note : file.notes) writer.put(note);
  for (const StatedUnit& unit : file.statedUnits) {
    writer.put(UnitValues{unit.metresPerUnit, unit.line});
    writer.put(unit.words);
  }
}

void take(CacheFileReader& reader, MeshFile& file) {
  Values values;
  reader.take(values);
  if (values.fileUp != 0) file.fileUp = static_cast<char>(values.fileUp);
  file.isCollada = values.isCollada != 0;
  file.facesOnly = values.facesOnly != 0;
  reader.take(file.mesh.vertices);
  reader.take(file.mesh.triangles);
  reader.take(file.format);
  reader.take(file.unitRule);
  reader.take(file.upRule);
  // A damaged number may be large. No more notes are taken than the file has pieces.
  for (std::uint32_t i = 0; i < values.notes && reader.isSound(); ++i)
    reader.take(file.notes.emplace_back());
  for (std::uint32_t i = 0; i < values.units && reader.isSound(); ++i) {
    UnitValues unit;
    reader.take(unit);
    StatedUnit& stated = file.statedUnits.emplace_back();
    stated.metresPerUnit = unit.metresPerUnit;
    stated.line = static_cast<int>(unit.line);
    reader.take(stated.words);
  }
}

}  // namespace

MeshFile cachedMeshFile(const std::string& bytes, const std::string& extension,
                        const MeshFileOptions& options, FileCache& cache,
                        const std::function<MeshFile()>& read) {
  if (bytes.size() < kLeastBytes) return read();
  // No unit and no axis are values that no option has.
  const double unit = options.metresPerUnit.value_or(0);
  const char up = options.up.value_or(0);
  const std::array<Bytes, 4> inputs = {bytesOf(bytes), bytesOf(extension), bytesOf(unit),
                                       bytesOf(up)};
  const Digest key = cache.key("mesh file", inputs);
  MeshFile file;
  if (cache.find(key, [&](CacheFileReader& reader) { take(reader, file); })) return file;
  file = read();
  if (file.otherFiles.empty())  // the key does not depend on other files
    cache.offer(key, [file](CacheFileWriter& writer) { put(file, writer); });
  return file;
}

}  // namespace corridor
