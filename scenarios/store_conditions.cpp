#include "scenarios/store_conditions.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace tarmac::scenarios {
namespace {

template <class T>
std::string json(const std::vector<T>& values) {
  return nlohmann::json(values).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

Conditions::Conditions(const ResultFilter& filter) {
  among("c.key", filter.keys);
  among("c.scenario", filter.scenarios);
  among("c.case_name", filter.cases);
  among("c.estimator", filter.estimators);
  if (!filter.seeds.empty()) add_list("c.seed", json(filter.seeds));
  for (const Override& parameter : filter.parameters) {
    sql_ += " and exists (select 1 from parameters p where p.cell = c.id and p.path = ? and p.value = ?)";
    bound_.push_back(parameter.first);
    bound_.push_back(parameter.second);
  }
}

void Conditions::among(const std::string& column, const std::vector<std::string>& values) {
  if (!values.empty()) add_list(column, json(values));
}

// As JSON a list is one value, and may be as long as it likes.
void Conditions::add_list(const std::string& column, std::string json) {
  sql_ += fmt::format(" and {} in (select value from json_each(?))", column);
  bound_.push_back(std::move(json));
}

void Conditions::bind(Statement& statement) const {
  for (std::size_t i = 0; i < bound_.size(); ++i) statement.bind(static_cast<int>(i) + 1, bound_[i]);
}

}  // namespace tarmac::scenarios
