#pragma once

#include <string>

#include "collision/hierarchy/tree_kinds.h"

/// The trees that the options of `corridor query` choose: those of hierarchy/tree_kinds.h, and the
/// octree, which has interference queries only.
namespace corridor::app {

/// The name of the octree (course/octree.h) as a volume. `volumeKinds()` does not contain it.
inline constexpr const char* kOctree = "octree";

/// Returns the words of --volume, --fit, --overlap and --build, with defaults instead of empty
/// words. @throws InputError for a word that is unknown, or that the volume does not have.
TreeNames chosenTrees(const TreeNames& words);

/// Tests that the volume is not the octree, for a query that octrees don't support. @throws
/// InputError if the volume is the octree.
/// @param trees as `chosenTrees` returns them. @param asked the name of the query that was chosen,
/// for the message.
void requireNoOctree(const TreeNames& trees, const std::string& asked);

/// Tests that --overlap is the volume's default, for a query that computes distances between
/// volumes, and so runs no overlap test. @throws InputError if --overlap is another test.
/// @param of the options whose queries run overlap tests, for the message. @param asked the name of
/// the query that was chosen, for the message.
void requireDefaultOverlap(const TreeNames& trees, const std::string& of, const std::string& asked);

}  // namespace corridor::app
