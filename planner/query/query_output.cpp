#include "planner/query/query_output.h"

#include <cstdio>
#include <iostream>

#include "collision/core/error.h"
#include "collision/core/quantiles.h"
#include "collision/core/simd_target.h"
#include "planner/app/output.h"
#include "planner/app/standard_streams.h"

namespace corridor::app {

namespace {

/// Returns the columns after the index of the pose. @pre the query is not `contacts`.
std::string columnsOf(const NamedQuery& query, const BatchResult& result, std::size_t pose) {
  char text[320];
  if (query.kind == QueryKind::distance) {
    const Distance& d = result.distances[pose];
    const Vec3 n = d.distance > 0 ? Vec3((d.p_WB - d.p_WA).stableNormalized()) : Vec3::Zero();
    std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g",
                  d.distance, d.p_WA.x(), d.p_WA.y(), d.p_WA.z(), d.p_WB.x(), d.p_WB.y(),
                  d.p_WB.z(), n.x(), n.y(), n.z());
    return text;
  }
  if (query.kind == QueryKind::depth) {
    const DepthBounds& d = result.depths[pose];
    const Vec3 along = d.direction_A + Vec3::Zero();  // 0 instead of −0
    const long long a = d.deepest ? d.deepest->a : -1LL, b = d.deepest ? d.deepest->b : -1LL;
    std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g,%.17g,%.17g,%lld,%lld", d.lower, d.upper,
                  along.x(), along.y(), along.z(), a, b);
    return text;
  }
  const Answer& answer = result.answers[pose];
  std::string hit = answer.hit ? "1" : "0";
  if (query.kind == QueryKind::tolerance) return hit;
  return hit + ',' + std::to_string(answer.boxTests) + ',' + std::to_string(answer.primitiveTests);
}

}  // namespace

void printCsv(const NamedQuery& query, const BatchResult& result) {
  std::string text = query.header + "\n";
  char line[256];
  if (query.kind == QueryKind::contacts) {
    for (const ContactRow& c : result.contacts) {
      std::snprintf(line, sizeof line, "%zu,%u,%u,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.pose,
                    c.a, c.b, c.p.x(), c.p.y(), c.p.z(), c.q.x(), c.q.y(), c.q.z());
      text += line;
    }
  } else {
    for (std::size_t i = 0; i < result.answers.size(); ++i)
      text += std::to_string(i) + ',' + columnsOf(query, result, i) + '\n';
  }
  std::cout << text;
  requireResultsWritten();
}

void printFrames(const NamedQuery& query, const std::vector<FrameResult>& frames) {
  std::string text = "frame," + query.header + ",refit_ms,query_ns\n";
  char times[64];
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t i = 0; i < frames[f].result.answers.size(); ++i) {
      std::snprintf(times, sizeof times, ",%.6g,%.1f\n", frames[f].refitMs,
                    frames[f].result.answers[i].ns);
      text += std::to_string(f) + ',' + std::to_string(i) + ',' +
              columnsOf(query, frames[f].result, i) + times;
    }
  std::cout << text;
  requireResultsWritten();
}

void printSummary(const BatchResult& result, const std::vector<std::string>& words) {
  std::vector<double> ns;
  double boxTests = 0, primitiveTests = 0, sum = 0;
  for (const Answer& answer : result.answers) {
    ns.push_back(answer.ns);
    sum += answer.ns;
    boxTests += static_cast<double>(answer.boxTests);
    primitiveTests += static_cast<double>(answer.primitiveTests);
  }
  const auto count = static_cast<double>(ns.size());
  for (const std::string& word : words) std::cerr << word << '\n';
  std::cerr << "simd=" << simdTarget() << '\n';
  const auto printLine = [](const char* key, const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    std::cerr << key << '=' << text << '\n';
  };
  printLine("median_ns", "%.1f", medianOf(ns));
  printLine("mean_ns", "%.1f", sum / count);
  printLine("p95_ns", "%.1f", quantileOf(ns, 0.95));
  printLine("bv_tests", "%.6g", boxTests / count);
  printLine("triangle_tests", "%.6g", primitiveTests / count);
  printLine("build_ms_a", "%.4f", result.buildMsA);
  printLine("build_ms_b", "%.4f", result.buildMsB);
  printLine("bytes_a", "%.0f", static_cast<double>(result.bytesA));
  printLine("bytes_b", "%.0f", static_cast<double>(result.bytesB));
  if (!std::cerr) throw InputError(Fault{"standard error", 0, "can't be written"});
}

void printMotions(const BatchResult& result) {
  std::string text =
      "motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,splits\n";
  char line[256];
  for (std::size_t i = 0; i < result.motions.size(); ++i) {
    const MotionAnswer& motion = result.motions[i];
    const MotionResult& r = motion.result;
    std::snprintf(line, sizeof line, "%zu,%s,%.17g,%.17g,%.17g,%d,%d,%llu,%llu,%llu\n", i,
                  nameOf(r.verdict), r.certifiedUntil, r.time, r.gap,
                  r.pair ? static_cast<int>(r.pair->primitiveA) : -1,
                  r.pair ? static_cast<int>(r.pair->primitiveB) : -1,
                  static_cast<unsigned long long>(result.answers[i].boxTests),
                  static_cast<unsigned long long>(result.answers[i].primitiveTests),
                  static_cast<unsigned long long>(motion.splits));
    text += line;
  }
  std::cout << text;
  requireResultsWritten();
}

}  // namespace corridor::app
