#include "estimators/blocks/robust_loss.h"

#include <cmath>
#include <stdexcept>

namespace tarmac::estimators {
namespace {

/// log(1 + exp(x)) without overflow.
double softplus(double x) {
  return x > 0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x));
}

RobustLoss::Value cauchy(double s, double c2) {
  const double shrink = 1 / (1 + s / c2);
  return {c2 * std::log1p(s / c2), shrink, -shrink * shrink / c2};
}

RobustLoss::Value huber(double s, double c) {
  if (s <= c * c) return {s, 1, 0};
  const double root = std::sqrt(s);
  return {2 * c * root - c * c, c / root, -c / (2 * s * root)};
}

RobustLoss::Value tolerant(double s, double c, double t) {
  const double x = (s - t) / c;
  const double first = 1 / (1 + std::exp(-x));
  return {c * (softplus(x) - softplus(-t / c)), first, first * (1 - first) / c};
}

RobustLoss::Value geman_mcclure(double s, double c2) {
  const double shrink = c2 / (c2 + s);
  return {s * shrink, shrink * shrink, -2 * shrink * shrink / (c2 + s)};
}

RobustLoss::Value dynamic_covariance_scaling(double s, double c2) {
  if (s <= c2) return {s, 1, 0};
  const double shrink = 2 * c2 / (c2 + s);
  return {3 * c2 - 2 * c2 * shrink, shrink * shrink, -2 * shrink * shrink / (c2 + s)};
}

}  // namespace

Loss loss_named(const std::string& name) {
  if (name == "standard") return Loss::standard;
  if (name == "cauchy") return Loss::cauchy;
  if (name == "huber") return Loss::huber;
  if (name == "tolerant") return Loss::tolerant;
  if (name == "truncated") return Loss::truncated;
  if (name == "geman-mcclure") return Loss::geman_mcclure;
  if (name == "dcs") return Loss::dcs;
  throw std::invalid_argument("no such loss: " + name);
}

RobustLoss::Value RobustLoss::operator()(double s) const {
  switch (kind) {
    case Loss::standard:
      return {s, 1, 0};
    case Loss::cauchy:
      return cauchy(s, scale * scale);
    case Loss::huber:
      return huber(s, scale);
    case Loss::tolerant:
      return tolerant(s, scale, tolerance);
    case Loss::truncated:
      return s < scale * scale ? Value{s, 1, 0} : Value{scale * scale, 0, 0};
    case Loss::geman_mcclure:
      return geman_mcclure(s, scale * scale);
    case Loss::dcs:
      return dynamic_covariance_scaling(s, scale * scale);
  }
  return {s, 1, 0};
}

}  // namespace tarmac::estimators
