#pragma once

#include <string>
#include <vector>

#include "planner/query/query_batch.h"

/// The output of `corridor query`: CSV on stdout, and a summary on stderr. The CSV is printed in a
/// single write. This is quick for millions of lines, and no line of stderr gets between them.
/// @throws InputError if it can't be printed.
namespace corridor::app {

void printCsv(const NamedQuery& query, const BatchResult& result);
/// Prints the answers for all shapes of a mesh that deforms. Each line also has the time of
/// refitting the tree to the shape, and the time of the query.
void printFrames(const NamedQuery& query, const std::vector<FrameResult>& frames);
void printMotions(const BatchResult& result);

/// Prints the summary, one entry `key=value` per line: first `words`, the entries that describe the
/// query and count its answers; then the times of the queries, mean counts of tests, and the trees'
/// build times and sizes.
void printSummary(const BatchResult& result, const std::vector<std::string>& words);

}  // namespace corridor::app
