#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"

/// What files hold that assimp 5.2 drops, moves or shrinks without a message. The program
/// corridor_assimp searches each file for such content before it believes assimp (README.md).
namespace corridor {

/// assimp chooses its importer by the extension, too.
enum class ContentKind { Collada, Gltf, BinaryGltf, ThreeMf, Other };

/// Returns the kind of a file from its extension, in lower case.
ContentKind contentKindOf(std::string_view extension);

/// The faults and notes of the files of one import, each text once.
class ContentReport {
 public:
  /// Adds a fault, unless there are ten, or one of the same text. @param line 0: the whole file
  void fault(const std::string& file, int line, const std::string& text);
  /// Adds a note.
  void note(const std::string& text);

  std::vector<Fault> faults;
  std::vector<std::string> notes;
  double fileUnit = 0;  ///< metres; 0: no 3MF file
  /// The largest sum of the lengths of the translations within one node of several: assimp adds
  /// them up in floats.
  double travelInNode = 0;
  /// The number of triangles in the file; nullopt if it is not counted.
  std::optional<double> triangles;

 private:
  std::set<std::string> known_;
};

/// Adds a fault for each thing in the file that could be geometry, or move geometry, and that
/// assimp does not read as the format's specification says; adds notes on optional content that is
/// not read. Does nothing for `Other`. Faults of syntax are left to assimp, unless assimp ignores
/// them.
void checkContent(ContentKind kind, const std::string& file, std::string_view bytes,
                  ContentReport& report);

/// Returns whether an axis (three numbers) or a quaternion (four) has the length 1, apart from its
/// digits. assimp does not normalise rotations: another length would distort the mesh.
bool hasLengthOne(const double* numbers, int size);

/// Returns whether assimp reads a decimal number as its value, apart from the rounding to floats
/// and from `kMostLostDecimals`. assimp's function for numbers of text (fast_atof) misreads those
/// of more than 18 digits before the point, and drops the decimals after the 15th, also where a
/// positive exponent follows.
bool isReadRightly(std::string_view word, double value);
/// What the decimals after the 15th may amount to.
constexpr double kMostLostDecimals = 1e-15;

/// The parts of `checkContent`.
/// @param isBinary whether the JSON is that of a GLB file
void checkGltf(const std::string& file, std::string_view json, ContentReport& report,
               bool isBinary = false);
void checkGlb(const std::string& file, std::string_view bytes, ContentReport& report);
void checkCollada(const std::string& file, std::string_view text, ContentReport& report);
/// Unpacks the model of an archive, which assimp reads from the file too, and checks it.
void checkThreeMf(const std::string& file, ContentReport& report);

}  // namespace corridor
