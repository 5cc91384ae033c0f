#include "tests/stress/audit/judge.h"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>

#include "collision/motion/rigid_motion.h"
#include "planner/checker/checker.h"
#include "planner/robot/edge_motion.h"

namespace corridor::audit {
namespace {

/// The smallest clearance that doubles resolve, as a fraction of the bodies' size: about the square
/// root of the unit roundoff. At a distance d the direction between the closest points is off by an
/// angle of 2^-53·size/d, which changes the computed clearance by up to size·2^-53·size/d. This
/// error equals d if d is about 2^-26 of the size.
constexpr double kResolved = 0x1p-26;

RigidPose poseOf(const Configuration& q) {
  return {q.head<3>(), Eigen::Quaterniond(Eigen::Vector4d(q.tail<4>()))};
}

RigidMotion rigidMotionOf(const Edge& edge) {
  const Tube tube{edge.tube.size() > 0 ? edge.tube[0] : 0,
                  edge.from.size() == 3 ? edge.tube[2] : edge.tube[3]};
  return edge.from.size() == 3 ? RigidMotion::planar(edge.from, edge.to, tube)
                               : RigidMotion::spatial(poseOf(edge.from), poseOf(edge.to), tube);
}

}  // namespace

void setMotion(EdgeMotion& motion, const Edge& edge) {
  if (edge.piece)
    motion.set(*edge.piece);
  else
    motion.set(edge.from, edge.to);
}

Body Case::body(bool tip) const {
  const Shape& shape = tip ? graze.tip() : rest;
  const char* which = tip ? "tip" : "rest";
  return shape.isMesh ? Body(which, shape.mesh) : Body(which, shape.part);
}

Scene Case::scene() const {
  std::vector<Scene::Placed> bodies;
  bodies.push_back({body(true), graze.tipFrame()});
  bodies.push_back({body(false), graze.restFrame()});
  return Scene(std::move(bodies), {{0, 1}});
}

PathProblem Case::problem() const {
  PathProblem problem;
  problem.tree = &edge.tree;
  problem.space = &edge.space;
  const auto add = [&](const Shape& shape, const char* which, std::size_t frame) {
    problem.bodies.push_back(
        {which, shape.isMesh ? &shape.mesh : nullptr,
         shape.isMesh ? std::span<const ConvexPart>() : std::span(&shape.part, 1), false, frame});
  };
  add(graze.tip(), "tip", graze.tipFrame());
  add(rest, "rest", graze.restFrame());
  problem.pairs = {{0, 1}};
  problem.margin = question.options.margin;
  problem.tube = edge.tube;
  problem.tolerance = question.options.tolerance;
  problem.workLimit = 1000;
  return problem;
}

double Case::largestUndecidedClearance() const {
  return 2 * std::max({question.options.tolerance, 4 * graze.rounding(), kResolved * graze.size()});
}

MotionResult answerOfModel(const Case& c) {
  Model model;
  model.tree = c.edge.tree;
  model.space = c.edge.space;
  model.robots.resize(1);
  for (const bool tip : {true, false}) {
    const Shape& shape = tip ? c.graze.tip() : c.rest;
    PlacedShape placed;
    placed.name = tip ? "tip" : "rest";
    if (shape.isMesh) {
      auto file = std::make_shared<MeshFile>();
      file->mesh = shape.mesh;
      placed.mesh = std::move(file);
    } else {
      placed.parts = {shape.part};
    }
    const std::size_t frame = tip ? c.graze.tipFrame() : c.graze.restFrame();
    // A body on the world's frame is an obstacle.
    const auto robot = frame == 0 ? std::nullopt : std::optional<std::size_t>(0);
    model.bodies.push_back({placed.name, frame, robot, {placed}});
  }
  CheckerOptions options;
  options.margin = c.question.options.margin;
  options.tube = c.edge.tube;
  options.tolerance = c.question.options.tolerance;
  const Checker checker(model, options);
  const bool earliest = c.question.options.earliest;
  return c.edge.piece ? checker.certifyCurve(*c.edge.piece, earliest)
                      : checker.certifyEdge(c.edge.from, c.edge.to, {.earliest = earliest});
}

std::optional<MotionResult> askChecker(const Case& c) {
  QueryContext context;
  const auto guarded = [&](const auto& ask) -> std::optional<MotionResult> {
    const Surroundings surroundings(c.question.mode);
    if (c.question.mode == Mode::usual) return ask();
    try {
      return ask();
    } catch (const std::exception&) {
      return std::nullopt;
    }
  };
  if (c.question.ofModel) return guarded([&] { return answerOfModel(c); });
  if (c.question.rigidMotion) {
    const Body tip = c.body(true), rest = c.body(false);
    const bool tipMoves = c.graze.tipFrame() != 0;
    const MotionPair pair{tipMoves ? &rest : &tip, tipMoves ? &tip : &rest};
    return guarded([&] {
      RigidEdge motion(rigidMotionOf(c.edge));
      return certifyMotionBy(c.question.method, motion, {&pair, 1}, c.question.options, context);
    });
  }
  const Scene scene = c.scene();
  EdgeMotion motion(c.edge.tree, c.edge.space, scene.framePairs(), c.edge.tube);
  return guarded([&] {
    setMotion(motion, c.edge);
    return scene.certify(motion, c.question.options, context, c.question.method);
  });
}

std::optional<PathReport> askVerifier(const Case& c) {
  const PathProblem problem = c.problem();
  std::vector<Configuration> states{c.edge.from};
  if (c.edge.from != c.edge.to) states.push_back(c.edge.to);
  const auto ask = [&] {
    return c.edge.piece ? verifyCurve(problem, {&*c.edge.piece, 1}) : verifyPath(problem, states);
  };
  const Surroundings surroundings(c.question.mode);
  if (c.question.mode == Mode::usual) return ask();
  try {
    return ask();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

Certificate certifiedAnswer(const Case& c) {
  const Scene scene = c.scene();
  EdgeMotion motion(c.edge.tree, c.edge.space, scene.framePairs(), c.edge.tube);
  setMotion(motion, c.edge);
  QueryContext context;
  MotionCertificate certificate;
  Certificate answer{scene.certify(motion, c.question.options, context, certificate)};
  if (answer.result.verdict == MotionVerdict::free)
    answer.accepted =
        !checkCertificate(motion, scene.motionPairs(), c.question.options, 1, certificate, context);
  return answer;
}

bool acceptsForged(const Case& c, double clearance, int intervals) {
  const Scene scene = c.scene();
  EdgeMotion motion(c.edge.tree, c.edge.space, scene.framePairs(), c.edge.tube);
  setMotion(motion, c.edge);
  QueryContext context;
  MotionCertificate certificate;
  for (int i = 0; i < intervals; ++i)
    certificate.free.push_back({0, double(i) / intervals, double(i + 1) / intervals, clearance});
  return !checkCertificate(motion, scene.motionPairs(), c.question.options, 1, certificate,
                           context);
}

double leftToHalfTurn(const Edge& edge) {
  const Quad pi = acosq(-1);
  Quad least = pi;
  for (const Coordinate& c : edge.space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::circle && !edge.piece)
      least = std::min(least, pi - magnitude(circleDifference(edge.from[i], edge.to[i])) -
                                  Quad(0x1p-49) * (std::abs(edge.from[i]) + std::abs(edge.to[i])));
    if (c.kind != Coordinate::Kind::rotation) continue;
    Quad product = 0, from = 0, to = 0;
    for (Eigen::Index k = i; k < i + 4; ++k) {
      product += Quad(edge.from[k]) * edge.to[k];
      from += Quad(edge.from[k]) * edge.from[k];
      to += Quad(edge.to[k]) * edge.to[k];
    }
    const Quad cosine = std::min(Quad(1), magnitude(product) / (sqrtq(from) * sqrtq(to)));
    least = std::min(least, pi - 2 * acosq(cosine));
  }
  return static_cast<double>(least);
}

std::string faultOf(const Case& c, const MotionResult& r) {
  const MotionOptions& o = c.question.options;
  std::ostringstream fault;
  if (r.verdict == MotionVerdict::free && c.truth.violates) fault << "FALSE FREE";
  if (c.truth.violates && r.certifiedUntil > c.truth.t)
    fault << " certified until " << r.certifiedUntil << ", beyond the contact";
  if (r.verdict == MotionVerdict::contact) {
    if (!(r.time >= 0 && r.time <= 1)) {
      fault << " contact at no time";
    } else if (const double apart = c.graze.apartAt(c.rest, r.time);
               apart > o.margin + c.graze.rounding()) {
      fault << " FALSE CONTACT at t = " << r.time << ", where they are " << apart << " m apart";
    }
    if (o.earliest && !r.grazing && r.time - r.certifiedUntil > o.timeTolerance)
      fault << " bracket of the first contact too wide";
  }
  if (r.verdict != MotionVerdict::undecided || c.question.mode > Mode::flushToZero)
    return fault.str();
  if (r.reason == UndecidedReason::ambiguous && !(leftToHalfTurn(c.edge) < 1.1e-9))
    fault << " reported as ambiguous, but no rotation is a half turn";
  if (r.reason == UndecidedReason::clearance && !c.question.inTube &&
      c.truth.apart > o.margin + o.clearanceSlack + c.largestUndecidedClearance())
    fault << " undecided at a clearance of " << c.truth.apart - o.margin << " m, gap " << r.gap;
  return fault.str();
}

std::string faultOf(const Case& c, const PathReport& r) {
  const double margin = c.question.options.margin;
  std::ostringstream fault;
  const std::string reason = r.findings.empty() ? "" : r.findings.front().reason;
  if (r.verdict == PathVerdict::proved && c.truth.violates)
    fault << "FALSE PROVED, clearance " << r.provedClearance;
  if (c.question.mode > Mode::flushToZero && r.verdict != PathVerdict::refuted) return fault.str();
  const bool halfTurn = reason == "ambiguous half turn";
  if (halfTurn && !(leftToHalfTurn(c.edge) < 1.1e-9))
    fault << " reported as ambiguous, but no rotation is a half turn";
  if (r.verdict == PathVerdict::refuted && !halfTurn) {
    const double t = r.findings.front().t;
    if (!c.question.inTube && c.graze.apartAt(c.rest, t) > margin + c.graze.rounding())
      fault << " FALSELY REFUTED (" << reason << ") at t = " << t << ", where they are "
            << c.graze.apartAt(c.rest, t) << " m apart";
  }
  if (r.verdict == PathVerdict::undecided && !c.question.inTube && reason != "work limit reached" &&
      c.truth.apart > margin + c.largestUndecidedClearance())
    fault << " undecided (" << reason << ") at a clearance of " << c.truth.apart - margin << " m";
  if (c.truth.apart - c.graze.rounding() > r.closestFound)
    fault << " met a distance of " << r.closestFound << " m, where there is none below "
          << c.truth.apart;
  return fault.str();
}

std::string describe(const Case& c) {
  std::ostringstream text;
  text << c.name << "\n" << std::hexfloat;
  const auto vec = [&](const auto& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) text << (i ? ", " : "{") << v[i];
    text << "}";
  };
  const char* joints[] = {"none", "turn", "slide", "shift", "rotate"};
  for (std::size_t f = 1; f < c.edge.tree.frames.size(); ++f) {
    const Frame& frame = c.edge.tree.frames[f];
    text << "frame " << f << ": on " << frame.parent << ", p ";
    vec(frame.fixed.p);
    text << ", q (x, y, z, w) ";
    vec(frame.fixed.q.coeffs());
    text << ", " << joints[static_cast<std::size_t>(frame.joint)] << " about ";
    vec(frame.axis);
    text << ", first variable " << static_cast<long>(frame.variable) << ", " << frame.count
         << " variables, multiplier " << frame.multiplier << ", offset " << frame.offset << "\n";
  }
  const char* kinds[] = {"line", "circle", "rotation"};
  for (const Coordinate& k : c.edge.space.coordinates())
    text << kinds[static_cast<std::size_t>(k.kind)] << " ";
  text << "\nfrom ";
  vec(c.edge.from);
  text << "\nto   ";
  vec(c.edge.to);
  text << "\ntube ";
  vec(c.edge.tube);
  if (c.edge.piece) {
    for (const auto& row : c.edge.piece->coefficients.rowwise()) {
      text << "\ncoefficients ";
      vec(row);
    }
    text << "\nerror ";
    vec(c.edge.piece->error);
  }
  for (const bool tip : {true, false}) {
    const Shape& shape = tip ? c.graze.tip() : c.rest;
    text << (tip ? "\ntip on frame " : "\nrest on frame ")
         << (tip ? c.graze.tipFrame() : c.graze.restFrame()) << ": "
         << (shape.isMesh          ? "mesh"
             : shape.part.flatEnds ? "cylinder"
                                   : "hull")
         << " of radius " << shape.part.radius << ", points ";
    for (const Vec3& p : shape.points()) vec(p);
    for (const auto& t : shape.mesh.triangles)
      text << " (" << t[0] << " " << t[1] << " " << t[2] << ")";
  }
  const MotionOptions& o = c.question.options;
  text << "\ntolerance " << o.tolerance << ", margin " << o.margin << ", clearanceSlack "
       << o.clearanceSlack << std::defaultfloat << ", earliest " << o.earliest << ", trees "
       << static_cast<int>(o.trees) << ", method "
       << edgeMethodNames()[static_cast<std::size_t>(c.question.method)]
       << (c.question.rigidMotion ? ", by RigidMotion" : "") << ", mode "
       << static_cast<int>(c.question.mode) << "\ntruth: at t = " << std::setprecision(17)
       << c.truth.t << (c.truth.violates ? " too close" : "") << ", all along at least "
       << c.truth.apart << " m apart; rounding " << c.graze.rounding() << " m\n";
  return text.str();
}

void Table::count(const std::string& row, const Truth& truth, double keep, Column answer,
                  bool isWrong) {
  if (!rows_.count(row)) names_.push_back(row);
  auto& counts = rows_[row];
  ++counts[cases];
  counts[truthContact] += truth.violates;
  counts[truthFree] += !truth.violates && truth.apart > keep;
  ++counts[answer];
  counts[wrong] += isWrong;
}

void Table::print(const std::string& title) const {
  const char* heads[] = {"cases",   "is free",   "touches",    "free",
                         "contact", "undecided", "work limit", "false"};
  std::cout << std::left << std::setw(34) << title << std::right;
  for (const char* head : heads) std::cout << std::setw(11) << head;
  std::cout << "\n";
  std::array<long, columns> all{};
  const auto line = [&](const std::string& name, const std::array<long, columns>& counts) {
    std::cout << std::left << std::setw(34) << name << std::right;
    for (const long n : counts) std::cout << std::setw(11) << n;
    std::cout << "\n";
  };
  for (const std::string& name : names_) {
    const auto& counts = rows_.at(name);
    for (std::size_t i = 0; i < columns; ++i) all[i] += counts[i];
    line(name, counts);
  }
  line("all", all);
}

long Table::sum(Column column) const {
  long all = 0;
  for (const auto& [name, counts] : rows_) all += counts[column];
  return all;
}

}  // namespace corridor::audit
