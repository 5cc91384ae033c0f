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
  /// What assimp does to the transforms within one node, at most over the nodes of the file.
  struct NodeBound {
    double length = 0;    ///< the sum of the lengths of several translations, without signs
    double rounding = 0;  ///< the relative error of the product of the transforms
  };
  NodeBound node;
  bool isText = false;  ///< coordinates and translations may have lost `kMostLostDecimals`
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
/// Returns by how much the square of that length differs from 1, up to the slack of `hasLengthOne`.
/// The rotation that assimp computes is off by twice as much.
double lengthError(const double* numbers, int size);

/// Returns whether assimp reads a decimal number as its value, apart from `kNumberRounding` and
/// from an absolute slack. assimp's function for numbers of text (fast_atof) misreads those of more
/// than 18 digits before the point, and drops the decimals after the 15th, also where a positive
/// exponent follows.
bool isReadRightly(std::string_view word, double value, double slack);
/// The relative rounding of a number that becomes a float: five roundings of 2^-24 in assimp's
/// function, and some slack.
constexpr double kNumberRounding = 0x1p-21;
/// What the decimals after the 15th amount to, if no exponent follows.
constexpr double kMostLostDecimals = 1e-15;
/// A length whose rounding is as large as what is lost in three directions.
constexpr double kLostLength = 1.8 * kMostLostDecimals / kNumberRounding;

/// The parts of `checkContent`.
/// @param isBinary whether the JSON is that of a GLB file
void checkGltf(const std::string& file, std::string_view json, ContentReport& report,
               bool isBinary = false);
void checkGlb(const std::string& file, std::string_view bytes, ContentReport& report);
void checkCollada(const std::string& file, std::string_view text, ContentReport& report);
/// Unpacks the model of an archive, which assimp reads from the file too, and checks it.
void checkThreeMf(const std::string& file, ContentReport& report);

}  // namespace corridor
