#include "planner/checker/pair_grids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "collision/core/digest.h"
#include "collision/core/file_cache.h"
#include "collision/core/rounding.h"
#include "collision/motion/certify_motion.h"
#include "collision/queries/surface_distance.h"
#include "planner/checker/chain_between.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

/// The least range of a number, as a part of its limits. The values of cells are then rounded by at
/// most 2^-52 / 2^-30 of the range, which is 2^-15 cells.
constexpr double kLeastRange = 0x1p-30;

/// Returns the frames between the bodies of a pair, if it may have a grid. Two primitives are
/// tested faster than a grid is looked up. A body inside a solid mesh is in contact, which a grid
/// does not test.
std::optional<ChainBetween> chainOf(const Model& model, const Scene& scene,
                                    const MotionPair& pair) {
  if (!pair.a->isMesh() && !pair.b->isMesh()) return std::nullopt;
  if (pair.a->isSolidMesh() || pair.b->isSolidMesh()) return std::nullopt;
  for (const std::size_t body : {pair.bodyA, pair.bodyB})  // obstacles belong to one problem
    if (scene.bodies()[body].frame == 0 || scene.bodies()[body].restX_WF) return std::nullopt;
  auto chain =
      chainBetween(model, scene.bodies()[pair.bodyA].frame, scene.bodies()[pair.bodyB].frame, 0);
  if (!chain || chain->box.size() > 2) return std::nullopt;
  for (const auto& [lower, upper] : chain->box)
    if (!std::isfinite(upper - lower) ||
        !(upper - lower > kLeastRange * std::max(std::abs(lower), std::abs(upper))))
      return std::nullopt;
  return chain;
}

std::vector<PairGrid::Axis> axesOf(const ChainBetween& chain, const Model& model) {
  std::vector<PairGrid::Axis> axes;
  for (std::size_t i = 0; i < chain.box.size(); ++i) {
    const auto [lower, upper] = chain.box[i];
    const bool isCircle = model.space.kindOfNumber(chain.numbers[i]) == Coordinate::Kind::circle;
    axes.push_back({chain.numbers[i], lower, (upper - lower) / double{PairGrid::kSide}, isCircle,
                    chain.isTurn[i] != 0});
  }
  return axes;
}

/// The digests of bodies, each computed once.
class BodyDigests {
 public:
  const Digest& of(const Body& body) {
    const void* const shape =
        body.isMesh() ? static_cast<const void*>(&body.mesh()) : body.parts().data();
    const auto [known, isNew] = known_.try_emplace(shape);
    if (!isNew) return known->second;
    Digester digester;
    if (body.isMesh()) {
      digester.add(bytesOf(body.mesh().vertices)).add(bytesOf(body.mesh().triangles));
    } else {
      for (const ConvexPart& part : body.parts())
        digester.add(bytesOf(part.points)).add(bytesOf(part.radius)).add(bytesOf(part.flatEnds));
    }
    return known->second = digester.result();
  }

 private:
  std::map<const void*, Digest> known_;
};

/// Returns the key of a grid: of the bodies, the frames between them, the values, the clearance.
Digest keyOf(const FileCache& cache, const ChainBetween& chain, const Digest& a, const Digest& b,
             double clearance) {
  Digester frames;
  for (const Frame& frame : chain.tree.frames) {
    const bool moves = frame.moves();
    frames.add(bytesOf(frame.parent)).add(bytesOf(frame.fixed.p));
    frames.add(std::as_bytes(std::span(frame.fixed.q.coeffs().data(), 4)));
    frames.add(bytesOf(frame.joint)).add(bytesOf(frame.axis)).add(bytesOf(moves));
    frames.add(bytesOf(frame.variable)).add(bytesOf(frame.multiplier)).add(bytesOf(frame.offset));
  }
  frames.add(bytesOf(chain.pair.a)).add(bytesOf(chain.pair.b));
  for (std::size_t i = 0; i < chain.box.size(); ++i)
    frames.add(bytesOf(chain.box[i].lower)).add(bytesOf(chain.box[i].upper));
  const Digest between = frames.result();
  const std::array<Bytes, 4> inputs = {bytesOf(a), bytesOf(b), bytesOf(between),
                                       bytesOf(clearance)};
  return cache.key("PairGrid", inputs);
}

/// Marks the cells in which two bodies keep a clearance: a block of cells is proved as a whole, by
/// a motion query in which nothing moves, with the block as the tube (collision/PROMISES.md,
/// promise 2), or is divided.
class GridBuilder {
 public:
  GridBuilder(const ChainBetween& chain, const MotionPair& pair,
              const std::vector<PairGrid::Axis>& axes, double clearance)
      : chain_(chain),
        pair_{pair.a, pair.b, 0, 0, 1},
        axes_(axes),
        marks_(PairGrid::wordsFor(axes.size())) {
    query_.tolerance = 1e-9;  // without effect, since nothing moves
    query_.workLimit = kWork;
    query_.margin = clearance;
  }

  PairGrid::Marks build() {
    constexpr std::int64_t kFirst = 32;
    for (std::int64_t c = 0; c < PairGrid::kSide; c += kFirst)
      for (std::int64_t r = 0; r < rows(); r += kFirst) divide({c, r, kFirst});
    return std::move(marks_);
  }

 private:
  struct Block {
    std::int64_t column = 0, row = 0, size = 1;
  };

  /// Blocks that take longer are divided; cells that take longer are not marked.
  static constexpr std::uint64_t kWork = 20'000;

  std::int64_t rows() const { return axes_.size() == 2 ? PairGrid::kSide : 1; }

  void divide(const Block& block) {
    if (isProved(block)) {
      for (std::int64_t c = block.column; c < block.column + block.size; ++c)
        for (std::int64_t r = block.row; r < std::min(block.row + block.size, rows()); ++r)
          PairGrid::mark(marks_, c, r);
      return;
    }
    // Where nine places of a small block are too close, few of its cells can be proved: they are
    // left unmarked.
    if (block.size == 1 || (block.size == 8 && isTooCloseAllOver(block))) return;
    const std::int64_t half = block.size / 2;
    for (const std::int64_t c : {block.column, block.column + half})
      for (const std::int64_t r : {block.row, block.row + half})
        if (r < rows() && (rows() > 1 || r == block.row)) divide({c, r, half});
  }

  /// The values at a place of the grid, in cells.
  Configuration valuesAt(double column, double row) const {
    Configuration q(static_cast<Eigen::Index>(axes_.size()));
    q[0] = axes_[0].lower + column * axes_[0].cell;
    if (axes_.size() == 2) q[1] = axes_[1].lower + row * axes_[1].cell;
    return q;
  }
  static double middle(std::int64_t first, std::int64_t size) {
    return static_cast<double>(first) + 0.5 * static_cast<double>(size);
  }

  bool isProved(const Block& block) {
    const Configuration q =
        valuesAt(middle(block.column, block.size), middle(block.row, block.size));
    if (isTooClose(q)) return false;
    Configuration half(q.size());
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const PairGrid::Axis& axis = axes_[static_cast<std::size_t>(i)];
      // The rounding of the middle is below the rest of the reach (`kLeastRange`).
      half[i] = roundedUp((0.5 * static_cast<double>(block.size) + PairGrid::kReach) * axis.cell);
    }
    EdgeMotion motion(chain_.tree, chain_.space, {&chain_.pair, 1}, half);
    motion.set(q, q);
    return certifyMotion(motion, {&pair_, 1}, query_, context_).verdict == MotionVerdict::free;
  }
  bool isTooClose(const Configuration& q) {
    const std::vector<Transform> X = framePoses(chain_.tree, q);
    return surfacesCloserThan(Posed(*pair_.a, X[chain_.pair.a]), Posed(*pair_.b, X[chain_.pair.b]),
                              query_.margin, context_);
  }
  bool isTooCloseAllOver(const Block& block) {
    for (const double i : {0.0, 0.5, 1.0})
      for (const double k : {0.0, 0.5, 1.0}) {
        const auto size = static_cast<double>(block.size);
        if (!isTooClose(valuesAt(static_cast<double>(block.column) + i * size,
                                 static_cast<double>(block.row) + k * size)))
          return false;
      }
    return true;
  }

  const ChainBetween& chain_;
  const MotionPair pair_;
  const std::vector<PairGrid::Axis>& axes_;
  MotionOptions query_;
  QueryContext context_;
  PairGrid::Marks marks_;
};

/// Calls visit(number of the pair, chain, key for each clearance) for each pair that may have
/// grids.
template <class Visit>
void forEachPair(const Model& model, const Scene& scene, const Visit& visit) {
  BodyDigests digests;
  const std::span<const MotionPair> pairs = scene.motionPairs();
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    const auto chain = chainOf(model, scene, pairs[k]);
    if (!chain) continue;
    std::vector<Digest> keys;
    for (const double clearance : PairGrids::kClearances)
      keys.push_back(
          keyOf(*model.cache, *chain, digests.of(*pairs[k].a), digests.of(*pairs[k].b), clearance));
    visit(k, *chain, keys);
  }
}

bool find(const FileCache& cache, const Digest& key, PairGrid::Marks& marks) {
  return cache.find(key, [&](CacheFileReader& reader) { reader.take(marks); });
}

}  // namespace

PairGrids::PairGrids(const Model& model, const Scene& scene, const Configuration& tube)
    : count_(scene.motionPairs().size()) {
  if (!model.cache) return;
  forEachPair(model, scene, [&](std::uint32_t k, const ChainBetween& chain, const auto& keys) {
    const std::vector<PairGrid::Axis> axes = axesOf(chain, model);
    for (const PairGrid::Axis& axis : axes)
      if (!(tube[static_cast<Eigen::Index>(axis.number)] <= PairGrid::kWidestTube * axis.cell))
        return;
    OfPair found{k, {}};
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (PairGrid::Marks marks; find(*model.cache, keys[i], marks))
        found.grids.emplace_back(axes, kClearances[i], std::move(marks));
    if (!found.grids.empty()) pairs_.push_back(std::move(found));
  });
}

std::size_t PairGrids::compute(const Model& model, const Scene& scene) {
  std::size_t count = 0;
  std::set<std::pair<std::uint64_t, std::uint64_t>> done;  // equal arms have equal pairs
  forEachPair(model, scene, [&](std::uint32_t k, const ChainBetween& chain, const auto& keys) {
    const std::vector<PairGrid::Axis> axes = axesOf(chain, model);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      PairGrid::Marks marks;
      if (!done.emplace(keys[i].high, keys[i].low).second || find(*model.cache, keys[i], marks))
        continue;
      marks = GridBuilder(chain, scene.motionPairs()[k], axes, kClearances[i]).build();
      model.cache->offer(keys[i], [marks](CacheFileWriter& writer) { writer.put(marks); });
      ++count;
    }
  });
  return count;
}

void PairGrids::prove(const Configuration& from, const Configuration& to,
                      const MotionOptions& options, std::vector<std::uint8_t>& proved) const {
  proved.assign(count_, 0);
  // The clearance that `certifyMotion` certainly proves.
  const double beyond = std::max(options.clearanceSlack, options.tolerance) + options.tolerance;
  for (const OfPair& pair : pairs_) {
    const double needed = roundedUp(options.marginOf(pair.pair) + beyond);
    const auto grid = std::ranges::find_if(
        pair.grids, [&](const PairGrid& each) { return needed <= each.clearance(); });
    proved[pair.pair] = grid != pair.grids.end() && grid->covers(from, to);
  }
}

}  // namespace corridor
