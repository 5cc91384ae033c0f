#pragma once

#include <string>
#include <vector>

#include "planner/query/query_batch.h"

/// The option --deform of `corridor query`: A changes its shape from frame to frame.
namespace corridor::app {

/// Tests that the query and the trees can be combined with --deform. @throws InputError if not.
void requireFrames(const NamedQuery& query, const TreeNames& trees);

/// All frames of a query together.
struct AllFrames {
  BatchResult result;  ///< the answers, frame by frame; build times and sizes of the trees
  double refitMs = 0;  ///< mean time to refit the tree of A to a frame
};
/// Runs a batch for A and each further shape of A, and prints one line per frame and pose. The tree
/// of A is refitted from frame to frame. The files of the further shapes are read one after
/// another, so that only one of these shapes is in memory.
/// @param nameA the file of A, for messages. @param files the files of the further shapes of A.
/// @throws InputError if a file can't be read, or has another number of triangles than A. In these
/// cases nothing is printed.
AllFrames queryFrames(const NamedQuery& query, const Batch& batch, const std::string& nameA,
                      const std::vector<std::string>& files);

}  // namespace corridor::app
