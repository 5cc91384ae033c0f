#include "planner/query/query_trees.h"

#include <utility>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/spelling.h"

namespace corridor::app {
namespace {

/// Returns the words for an octree. A cell is an AABB, which octrees fit and test in one way.
TreeNames octreeWords(const TreeNames& words) {
  TreeNames own = {kOctree, "plain", "sat", "top-down"};
  const auto require = [](const char* option, const std::string& word, const std::string& only) {
    if (!word.empty() && word != only)
      throw InputError(
          Fault{option, 0, quotedWord(word) + " is not for octrees; volume octree has: " + only});
  };
  require("--fit", words.fit, own.fit);
  require("--overlap", words.overlap, own.overlap);
  require("--build", words.build, own.build);
  return own;
}

}  // namespace

TreeNames chosenTrees(const TreeNames& words) {
  if (words.volume == kOctree) return octreeWords(words);
  auto wrong = invalidNameIn(words);
  if (!wrong) return withDefaults(words);
  if (wrong->key == "volume") {
    std::vector<std::string> names;
    for (const VolumeKind& kind : volumeKinds()) names.push_back(kind.name);
    names.emplace_back(kOctree);
    wrong->text = "unknown volume " + quotedWord(words.volume) + didYouMean(words.volume, names) +
                  "; there are: " + joined(names);
  }
  throw InputError(Fault{"--" + wrong->key, 0, wrong->text});
}

void requireNoOctree(const TreeNames& trees, const std::string& asked) {
  if (trees.volume == kOctree)
    throw InputError(Fault{"--volume", 0,
                           "octree supports only --query interference at poses, not " + asked +
                               "; choose another volume, such as aabb"});
}

void requireDefaultOverlap(const TreeNames& trees, const std::string& of,
                           const std::string& asked) {
  if (trees.overlap == withDefaults({trees.volume, "", ""}).overlap) return;
  throw InputError(Fault{"--overlap", 0,
                         quotedWord(trees.overlap) + " needs " + of + "; " + asked +
                             " computes distances between volumes"});
}

}  // namespace corridor::app
