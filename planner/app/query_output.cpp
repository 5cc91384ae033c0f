#include "planner/app/query_output.h"

#include <cstdio>
#include <iostream>

#include "collision/core/error.h"
#include "collision/core/quantiles.h"
#include "collision/core/simd_target.h"
#include "planner/app/output.h"
#include "planner/app/standard_streams.h"

namespace corridor::app {

void printCsv(const NamedQuery& query, const BatchResult& result) {
  std::string text = query.header + "\n";
  char line[256];
  if (query.kind == QueryKind::contacts) {
    for (const ContactRow& c : result.contacts) {
      std::snprintf(line, sizeof line, "%zu,%u,%u,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.pose,
                    c.a, c.b, c.p.x(), c.p.y(), c.p.z(), c.q.x(), c.q.y(), c.q.z());
      text += line;
    }
  } else if (query.kind == QueryKind::distance) {
    for (std::size_t i = 0; i < result.distances.size(); ++i) {
      const Distance& d = result.distances[i];
      const Vec3 n = d.distance > 0 ? Vec3((d.p_WB - d.p_WA).stableNormalized()) : Vec3::Zero();
      std::snprintf(line, sizeof line,
                    "%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", i,
                    d.distance, d.p_WA.x(), d.p_WA.y(), d.p_WA.z(), d.p_WB.x(), d.p_WB.y(),
                    d.p_WB.z(), n.x(), n.y(), n.z());
      text += line;
    }
  } else if (query.kind == QueryKind::depth) {
    for (std::size_t i = 0; i < result.depths.size(); ++i) {
      const DepthBounds& d = result.depths[i];
      const auto number = [](const auto& pair, auto member) {
        return pair ? static_cast<long long>((*pair).*member) : -1LL;
      };
      std::snprintf(line, sizeof line, "%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%lld,%lld\n", i, d.lower,
                    d.upper, d.direction_A.x(), d.direction_A.y(), d.direction_A.z(),
                    number(d.deepest, &PrimitivePair::a), number(d.deepest, &PrimitivePair::b));
      text += line;
    }
  } else if (query.kind == QueryKind::tolerance) {
    for (std::size_t i = 0; i < result.answers.size(); ++i)
      text += std::to_string(i) + ',' + (result.answers[i].hit ? "1\n" : "0\n");
  } else {
    for (std::size_t i = 0; i < result.answers.size(); ++i) {
      const Answer& answer = result.answers[i];
      text += std::to_string(i) + ',' + (answer.hit ? '1' : '0') + ',' +
              std::to_string(answer.boxTests) + ',' + std::to_string(answer.triangleTests) + '\n';
    }
  }
  std::cout << text;
  requireResultsWritten();
}

void printSummary(const BatchResult& result, const std::vector<std::string>& words) {
  std::vector<double> ns;
  double boxTests = 0, triangleTests = 0, sum = 0;
  for (const Answer& answer : result.answers) {
    ns.push_back(answer.ns);
    sum += answer.ns;
    boxTests += static_cast<double>(answer.boxTests);
    triangleTests += static_cast<double>(answer.triangleTests);
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
  printLine("triangle_tests", "%.6g", triangleTests / count);
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
                  nameOf(r.verdict), r.certifiedUntil, r.contactTime, r.gap,
                  r.pair ? static_cast<int>(r.pair->triangleA) : -1,
                  r.pair ? static_cast<int>(r.pair->triangleB) : -1,
                  static_cast<unsigned long long>(result.answers[i].boxTests),
                  static_cast<unsigned long long>(result.answers[i].triangleTests),
                  static_cast<unsigned long long>(motion.splits));
    text += line;
  }
  std::cout << text;
  requireResultsWritten();
}

}  // namespace corridor::app
