#include "planner/solve/shorten_curve.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "planner/solve/curve_measure.h"
#include "planner/solve/smooth_pieces.h"
#include "planner/trajectory/path_view.h"

namespace corridor {
namespace {

constexpr int kScales = 5;      ///< parts are 1, 1/2, … 1/2^(kScales - 1) of the curve
constexpr int kPasses = 4;      ///< maximum number of passes over all parts
constexpr double kGain = 5e-4;  ///< least fraction of the measure that a replacement must save
/// If the distance of a place from an end of its piece is less than this fraction of the piece, the
/// place is moved to this end. Otherwise very short pieces would arise; and if a piece is much
/// shorter than the magnitude of its coordinates, its tangent is inexact.
constexpr double kLeastShare = 0.05;
/// ∫κ² ds times the length is about the square of the angle (rad) by which a curve turns. A piece
/// with a product of at most this value counts as straight.
constexpr double kAngle2 = 1e-12;

struct CurvePlace {
  std::size_t piece = 0;
  double tau = 0;
};

/// A point of the curve with the derivatives by a parameter of unit speed.
struct PointOfCurve {
  Configuration value, first, second;
};

std::pair<CurvePiece, CurvePiece> splitAt(const CurvePiece& piece, double tau) {
  std::pair<CurvePiece, CurvePiece> parts{piece, piece};
  Eigen::MatrixXd& left = parts.first.coefficients;
  Eigen::MatrixXd& right = parts.second.coefficients;
  for (Eigen::Index level = 1; level < left.cols(); ++level) {  // de Casteljau
    const Eigen::Index rest = left.cols() - level;
    right.leftCols(rest) =
        ((1 - tau) * right.leftCols(rest) + tau * right.middleCols(1, rest)).eval();
    left.col(level) = right.col(0);
  }
  return parts;
}

class Shortener {
 public:
  Shortener(const ConfigurationSpace& space, std::vector<CurvePiece> pieces,
            const CurveTest& isFree, const SmoothOptions& options,
            const std::function<bool()>& stop)
      : space_(space),
        isFree_(isFree),
        stop_(stop),
        goal_(options.goal),
        ruler_(space, options.velocity, options.acceleration) {
    result_.pieces = std::move(pieces);
    fractions_ = options.fractions;
    fractions_.resize(result_.pieces.size(), 0);
    for (const CurvePiece& piece : result_.pieces) measured_.push_back(ruler_.of(piece));
    for (std::size_t k = 0; k + 1 < result_.pieces.size(); ++k)
      angles_.push_back(angleBetween(result_.pieces[k], result_.pieces[k + 1]));
    angles_.push_back(0);
    madeIn_.assign(result_.pieces.size(), 0);
  }

  ShortCurve run() {
    // The last section comes first, so that the indices of the sections before it stay valid.
    for (std::size_t end = pieces().size(); end > 0;) {
      if (isRotating(end - 1)) {
        --end;
        continue;
      }
      begin_ = end - 1;
      while (begin_ > 0 && !isRotating(begin_ - 1)) --begin_;
      end_ = end;
      end = begin_;
      shortenSection();
    }
    return std::move(result_);
  }

 private:
  const std::vector<CurvePiece>& pieces() const { return result_.pieces; }

  void shortenSection() {
    std::vector<const MeasuredPiece*> section;
    for (std::size_t k = begin_; k < end_; ++k) section.push_back(&measured_[k]);
    const auto first = angles_.begin() + static_cast<std::ptrdiff_t>(begin_);
    value_ = ruler_.along(section, {first, first + static_cast<std::ptrdiff_t>(end_ - begin_) - 1})
                 .valueFor(goal_);
    for (pass_ = 0; pass_ < kPasses; ++pass_) {
      const std::size_t before = result_.replaced;
      for (int scale = 0; scale < kScales; ++scale) {
        const int parts = 1 << scale;
        // Adjacent parts overlap by half.
        for (int k = 0; k <= 2 * (parts - 1); ++k) {
          if (stop_()) return;
          replace(placeAt(0.5 * k / parts), placeAt((0.5 * k + 1) / parts));
        }
      }
      if (result_.replaced == before) return;
    }
  }

  /// Returns the place at which the fraction `share` of the section's estimated time has passed. If
  /// this place is near an end of its piece, returns the end instead (kLeastShare).
  CurvePlace placeAt(double share) const {
    double rest = 0;
    for (std::size_t k = begin_; k < end_; ++k) rest += share * measured_[k].time;
    std::size_t k = begin_;
    while (k + 1 < end_ && rest > measured_[k].time) rest -= measured_[k++].time;
    const double time = measured_[k].time;
    const double tau = time > 0 ? std::min(rest / time, 1.0) : 0;
    if (tau < kLeastShare) return {k, 0};
    if (tau <= 1 - kLeastShare) return {k, tau};
    return k + 1 < end_ ? CurvePlace{k + 1, 0} : CurvePlace{k, 1};
  }

  PointOfCurve pointAt(std::size_t piece, double tau) const {
    const std::vector<CurvePiece> path{pieces()[piece]};
    const PathView view(path, space_);
    PointOfCurve point;
    point.value = tau == 0   ? Configuration(path[0].coefficients.col(0))
                  : tau == 1 ? Configuration(path[0].coefficients.rightCols<1>())
                             : view.value(0, tau);
    view.derivatives(0, tau, point.first, point.second);
    const double speed = ruler_.timeOf(point.first);
    if (speed > 0) point.first /= speed, point.second /= speed * speed;
    return point;
  }

  bool isRotating(std::size_t piece) const {
    const auto& c = pieces()[piece].coefficients;
    return rotates(space_, c.col(0), c.rightCols<1>());
  }

  /// Returns the angle between the tangents of two pieces that follow each other.
  double angleBetween(const CurvePiece& a, const CurvePiece& b) const {
    const auto& c = a.coefficients;
    return ruler_.angleBetween(c.rightCols<1>() - c.col(c.cols() - 2),
                               b.coefficients.col(1) - b.coefficients.col(0));
  }

  /// Returns the piece of degree 5 between two points, with the speed `speed` at both ends. At an
  /// end of the curve (`freeStart`, `freeEnd`) no tangent is given: there the piece begins or ends
  /// straight. Rotations rest as in `resting`.
  CurvePiece pieceBetween(const PointOfCurve& a, bool freeStart, const PointOfCurve& b,
                          bool freeEnd, double speed, const Configuration& resting) const {
    CurvePiece piece;
    piece.error = Configuration::Zero(a.value.size());
    auto& c = piece.coefficients;
    c.resize(a.value.size(), 6);
    c.col(0) = a.value, c.col(5) = b.value;
    c.col(1) = a.value + speed / 5 * a.first;
    c.col(2) = 2 * c.col(1) - a.value + speed * speed / 20 * a.second;
    c.col(4) = b.value - speed / 5 * b.first;
    c.col(3) = 2 * c.col(4) - b.value + speed * speed / 20 * b.second;
    // Three coefficients at equal distances on a line make the second derivative 0 at this end.
    if (freeStart && freeEnd) {
      for (int i = 1; i < 5; ++i) c.col(i) = c.col(0) + i / 5.0 * (c.col(5) - c.col(0));
    } else if (freeStart) {
      for (int i = 1; i < 3; ++i) c.col(i) = c.col(0) + i / 3.0 * (c.col(3) - c.col(0));
    } else if (freeEnd) {
      for (int i = 1; i < 3; ++i) c.col(5 - i) = c.col(5) + i / 3.0 * (c.col(2) - c.col(5));
    }
    restRotations(space_, resting, piece);
    return piece;
  }

  bool isProved(const CurvePiece& piece, double fraction) {
    if (!isWithinBounds(space_, piece)) return false;
    ++result_.tests;
    return isFree_(piece, fraction);
  }

  /// Replaces the part between two places by a new piece, if the new piece is proved and reduces
  /// the measure that `options.goal` chooses.
  void replace(const CurvePlace& from, const CurvePlace& to) {
    const std::size_t last = to.tau > 0 ? to.piece : to.piece - 1;  // last piece of the part
    if (to.piece < from.piece || (to.piece == from.piece && to.tau <= from.tau)) return;
    const bool freeStart = from.piece == begin_ && from.tau == 0,
               freeEnd = to.piece + 1 == end_ && to.tau == 1;
    // At both ends, the new piece gets the tangent of the curve outside of the part. So a corner at
    // an end of the part disappears.
    const bool atJoint = from.tau == 0 && !freeStart;
    const PointOfCurve a = atJoint ? pointAt(from.piece - 1, 1) : pointAt(from.piece, from.tau),
                       b = pointAt(to.piece, to.tau);

    std::vector<CurvePiece> before, after;  // the rest of the part's first and last piece
    bool stops = false, isStraight = true, isChanged = false;
    for (std::size_t k = atJoint ? from.piece - 1 : from.piece; k < to.piece; ++k)
      stops = stops || angles_[k] > 0;
    for (std::size_t k = from.piece; k <= last; ++k) {
      isStraight = isStraight && measured_[k].bend * measured_[k].length <= kAngle2;
      isChanged = isChanged || madeIn_[k] + 1 >= pass_;
    }
    if (!isChanged || (isStraight && !stops)) return;
    if (from.tau > 0) before.push_back(splitAt(pieces()[from.piece], from.tau).first);
    if (to.tau > 0 && !freeEnd) after.push_back(splitAt(pieces()[last], to.tau).second);

    // `section` describes the section as it would be with one new piece instead of the part.
    std::vector<MeasuredPiece> own;  // the measures of `before`, the new piece and `after`
    for (const CurvePiece& piece : before) own.push_back(ruler_.of(piece));
    const std::size_t place = own.size();
    own.emplace_back();
    for (const CurvePiece& piece : after) own.push_back(ruler_.of(piece));
    std::vector<const MeasuredPiece*> section;
    std::vector<double> angles;
    for (std::size_t k = begin_; k < from.piece; ++k) {
      section.push_back(&measured_[k]);
      angles.push_back(k + 1 < from.piece || from.tau > 0 ? angles_[k] : 0);
    }
    for (const MeasuredPiece& piece : own) section.push_back(&piece), angles.push_back(0);
    if (!after.empty()) angles.back() = angles_[last];
    for (std::size_t k = last + 1; k < end_; ++k) {
      section.push_back(&measured_[k]);
      angles.push_back(angles_[k]);
    }
    angles.pop_back();

    std::optional<CurvePiece> best;
    MeasuredPiece bestMeasured;
    double least = (1 - kGain) * value_;
    const double gap = ruler_.timeOf(b.value - a.value);
    for (const double share : {1.0, 0.7, 1.4}) {
      CurvePiece piece = pieceBetween(a, freeStart, b, freeEnd, share * gap,
                                      pieces()[from.piece].coefficients.col(0));
      own[place] = ruler_.of(piece);
      const double value = ruler_.along(section, angles).valueFor(goal_);
      if (!(value < least)) continue;
      least = value;
      best = std::move(piece), bestMeasured = own[place];
    }
    if (!best) return;
    if (!before.empty()) best->coefficients.col(0) = before[0].coefficients.rightCols<1>();
    if (!after.empty()) best->coefficients.col(5) = after[0].coefficients.col(0);
    std::vector<double> fractions(own.size(), 1);
    for (std::size_t k = from.piece; k <= last; ++k)
      fractions[place] = std::min(fractions[place], fractions_[k]);
    if (!before.empty()) fractions.front() = fractions_[from.piece];
    if (!after.empty()) fractions.back() = fractions_[last];
    if (!isProved(*best, fractions[place])) return;

    own[place] = std::move(bestMeasured);
    value_ = least;
    std::vector<CurvePiece> inserted = std::move(before);
    inserted.push_back(std::move(*best));
    for (CurvePiece& piece : after) inserted.push_back(std::move(piece));
    const auto exchange = [&](auto& all, auto& some) {
      const auto at = all.erase(all.begin() + static_cast<std::ptrdiff_t>(from.piece),
                                all.begin() + static_cast<std::ptrdiff_t>(last) + 1);
      all.insert(at, some.begin(), some.end());
    };
    const std::vector<int> now(own.size(), pass_);
    // At both ends of the new piece the tangent is continuous.
    std::vector<double> joints(own.size(), 0);
    joints.back() = after.empty() ? 0 : angles_[last];
    if (atJoint) angles_[from.piece - 1] = 0;
    exchange(madeIn_, now);
    exchange(angles_, joints);
    exchange(measured_, own);
    exchange(fractions_, fractions);
    exchange(result_.pieces, inserted);
    end_ += inserted.size() - (last + 1 - from.piece);
    ++result_.replaced;
  }

  const ConfigurationSpace& space_;
  const CurveTest& isFree_;
  const std::function<bool()>& stop_;
  Smoothing goal_;
  CurveRuler ruler_;
  std::vector<MeasuredPiece> measured_;
  std::vector<double> angles_;     // from each piece to the next; 0: the tangent is continuous
  std::vector<int> madeIn_;        // the pass in which each piece was made
  std::vector<double> fractions_;  // of the clearance targets, which each piece keeps
  int pass_ = 0;
  double value_ = 0;  // the measure that is reduced, of the section
  ShortCurve result_;
  std::size_t begin_ = 0, end_ = 0;  // pieces of the section, in which no rotation moves
};

}  // namespace

ShortCurve shortenedCurve(const ConfigurationSpace& space, std::vector<CurvePiece> pieces,
                          const CurveTest& isFree, const SmoothOptions& options,
                          const std::function<bool()>& stop) {
  return Shortener(space, std::move(pieces), isFree, options, stop).run();
}

}  // namespace corridor
