#include "metrics/paired_logs.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

#include "metrics/statistics.h"

namespace tarmac::metrics {

namespace {

boost::math::students_t student(std::size_t n) {
  if (n < 2) throw std::invalid_argument("Student's distribution: expected at least 2 values");
  return boost::math::students_t(static_cast<double>(n - 1));
}

}  // namespace

std::vector<double> log_ratios(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) throw std::invalid_argument("log_ratios: the two lists belong together in pairs");
  std::vector<double> logs;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] > 0 && b[k] > 0 && std::isfinite(a[k]) && std::isfinite(b[k])) logs.push_back(std::log(a[k] / b[k]));
  return logs;
}

LogSummary summarise(const std::vector<double>& values) {
  LogSummary s;
  s.n = values.size();
  if (values.empty()) return s;
  s.mean = mean(values);
  if (s.n < 2) return s;
  double squares = 0;
  for (const double v : values) squares += (v - s.mean) * (v - s.mean);
  const double n = static_cast<double>(s.n);
  s.sd = std::sqrt(squares / (n - 1));
  s.error = s.sd / std::sqrt(n);
  return s;
}

double student_quantile(std::size_t n, double probability) {
  return boost::math::quantile(student(n), probability);
}

double student_above(std::size_t n, double t) {
  return boost::math::cdf(boost::math::complement(student(n), t));
}

}  // namespace tarmac::metrics
