/// Numeric derivatives of functions of one number, as twins for jets.
#pragma once

namespace tarmac::tests {

/// Central difference with one step of Richardson's extrapolation: error of fourth order.
template <class F>
auto derivative_of(const F& f, double x, double step) -> decltype(f(x)) {
  using Value = decltype(f(x));
  const auto central = [&](double h) -> Value { return (f(x + h) - f(x - h)) / (2 * h); };
  return (4 * central(step / 2) - central(step)) / 3;
}

}  // namespace tarmac::tests
