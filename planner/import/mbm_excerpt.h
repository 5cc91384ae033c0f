#pragma once

#include <string>

namespace corridor {

/// Returns the text of a MotionBenchMaker set (mbm_json.h) in which all problems but one have only
/// their index left: reading one problem of fifty then takes little longer than reading one alone.
/// The other problems are not parsed, so faults in them, such as a key that is there twice, are not
/// found. What is left keeps its line. Returns the text unchanged if it is not laid out as such a
/// set, or if an index is not a whole number: the reader then reports what is wrong.
/// @param index the index of the problem that stays.
std::string excerptOfSet(std::string text, const std::string& index);

}  // namespace corridor
