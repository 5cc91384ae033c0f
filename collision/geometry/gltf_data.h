#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/transform.h"
#include "collision/geometry/gltf_json.h"

namespace corridor::gltf {

/// The numbers of a glTF file: its buffers, and what its accessors say of them.
class Data {
 public:
  /// @param file   buffers in other files are in its folder
  /// @param chunk  the binary chunk of a GLB file
  Data(Document& document, const std::string& file, std::optional<std::string_view> chunk)
      : document_(document), file_(file), chunk_(chunk) {}

  /// Appends the positions of an accessor. @throws InputError if they can't be read.
  void readPositions(const Json& accessor, std::vector<Vec3>& vertices);
  /// Returns the indices of an accessor. Adds a fault if they can't be read.
  std::vector<std::uint32_t> readIndices(const Json& accessor);
  /// The other files that were read.
  const std::vector<std::string>& otherFiles() const { return otherFiles_; }

 private:
  /// Elements of an accessor, or of a part of one, in memory.
  struct Elements {
    const char* first = nullptr;
    std::uint64_t stride = 0;
  };

  Elements elements(const Json& part, std::uint64_t count, std::uint64_t size,
                    const std::string& what);
  const std::string* buffer(std::uint32_t number);
  std::string contentsOf(const std::string& uri, const std::string& what);
  std::uint32_t checkAccessor(const Json& accessor, const char* type, const std::string& what);
  template <class Take>
  void forElements(const Json& accessor, const Elements& stored, std::uint32_t count,
                   std::uint64_t size, const std::string& what, const Take& take);

  Document& document_;
  const std::string& file_;
  std::optional<std::string_view> chunk_;
  std::map<std::uint32_t, std::string> buffers_;
  std::uint64_t unstored_ = 0;  ///< positions without a bufferView
  std::vector<std::string> otherFiles_;
};

}  // namespace corridor::gltf
