#include "planner/import/moveit_matrix.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/spelling.h"
#include "planner/problem/urdf_robot.h"

namespace corridor {
namespace {

const MapKeys kMatrix{
    {"entry_names", "entry_values", "default_entry_names", "default_entry_values"}, {}};

/// Replaces the pairs of bodies that are not tested.
/// @param allowed the matrix: for each name, its row of values.
void replacePairs(const std::vector<std::string>& names,
                  const std::vector<std::vector<bool>>& allowed, Model& model, YamlSource& source) {
  std::map<std::string, std::size_t> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) bodies[model.bodies[b].name] = b;
  const Required any = Required::beyondProofs();  // the matrix has no say about proofs
  for (std::size_t a = 0; a < model.bodies.size(); ++a)
    for (std::size_t b = a + 1; b < model.bodies.size() && model.bodies[b].robot; ++b)
      if (model.filter.whyNotTested(a, b, any).starts_with("SRDF")) model.filter.include(a, b);
  // The SRDF's reason may have hidden that robot.yaml allows the pair, too.
  for (const AllowedPair& pair : model.robots.front().description.allowed) {
    const auto a = bodies.find(pair.a), b = bodies.find(pair.b);
    if (pair.reason == kAllowedByRobot && a != bodies.end() && b != bodies.end() &&
        model.filter.whyNotTested(a->second, b->second, any).empty())
      model.filter.skip(a->second, b->second, pair.reason);
  }
  std::vector<std::string> tested, adjacent;
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const auto a = bodies.find(names[i]), b = bodies.find(names[k]);
      if (a == bodies.end() || b == bodies.end()) continue;
      const std::string_view why = model.filter.whyNotTested(a->second, b->second, any);
      const std::string pair = names[k] + " ~ " + names[i];
      if (allowed[i][k]) {
        if (why.empty()) model.filter.skip(a->second, b->second, "allowed_collision_matrix");
      } else if (why == kAllowedByRobot) {
        tested.push_back(pair);
        model.filter.include(a->second, b->second);
      } else if (why == "adjacent") {
        adjacent.push_back(pair);
      }
    }
  const std::string matrix = source.file + ": allowed_collision_matrix: ";
  if (!tested.empty())
    source.notes.push_back(
        {matrix + "tested, although robot.yaml allows them to touch: " + joinedFirst(tested),
         NoteWeight::motion});
  if (!adjacent.empty())
    source.notes.push_back({matrix +
                                "not tested, although the matrix has false, because the "
                                "links are adjacent: " +
                                joinedFirst(adjacent),
                            NoteWeight::coverage});
}

}  // namespace

void applyAllowedMatrix(const YamlMap& scene, Model& model) {
  const YamlValue* const value = scene.find("allowed_collision_matrix");
  if (!value || value->kind != YamlValue::Kind::Map) return;
  YamlSource& source = scene.source();
  const YamlMap map(*value, "allowed_collision_matrix", &kMatrix, source);
  if (isEmpty(map, "entry_names")) return;
  const auto names = readWords(*map.find("entry_names"), "such as [hand, table]",
                               "allowed_collision_matrix.entry_names", source);
  const auto rows = itemsOf(map, "entry_values");
  if (!names) return;
  if (std::set<std::string> known; !std::ranges::all_of(
          *names, [&](const std::string& name) { return known.insert(name).second; }))
    return map.fault("entry_names", "a name is listed twice, so its rows may disagree");
  if (rows.size() != names->size())
    return map.fault("entry_values", std::to_string(names->size()) + " rows are needed, not " +
                                         std::to_string(rows.size()));
  std::vector<std::vector<bool>> allowed;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // A row is a list, or a message with the list `enabled`.
    const YamlValue* row = rows[i];
    if (row->kind == YamlValue::Kind::Map)
      if (const YamlValue* const enabled =
              YamlMap(*row, "allowed_collision_matrix.entry_values", nullptr, source)
                  .find("enabled"))
        row = enabled;
    const std::string path = "allowed_collision_matrix.entry_values[" + std::to_string(i) + "]";
    const auto words = readWords(*row, "such as [true, false]", path, source);
    if (!words) return;
    if (words->size() != names->size())
      return source.fault(row->line, path + ": " + std::to_string(names->size()) +
                                         " values are needed, not " +
                                         std::to_string(words->size()));
    std::vector<bool>& values = allowed.emplace_back();
    for (const std::string& word : *words) {
      values.push_back(lowered(word) == "true" || word == "1");
      if (!values.back() && lowered(word) != "false" && word != "0")
        return source.fault(row->line, path + ": true or false is needed, not " + quotedWord(word));
    }
    for (std::size_t k = 0; k < i; ++k)
      if (values[k] != allowed[k][i])
        return source.fault(
            row->line, path + ": the matrix is not symmetric: " + quotedWord((*names)[i]) +
                           " and " + quotedWord((*names)[k]) + " are allowed in one order only");
  }
  replacePairs(*names, allowed, model, source);
}

}  // namespace corridor
