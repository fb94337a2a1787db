/// Tables, views and versions of store.sqlite. Private to scenarios/.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "scenarios/cell.h"
#include "scenarios/sqlite.h"
#include "scenarios/store.h"

namespace tarmac::scenarios {

/// Leads from one version of the schema to the next.
struct Migration {
  int from = 0;
  const char* sql = "";  ///< statements
};

/// A schema: its version, and how older ones become it.
struct Schema {
  int version = kStoreSchema;
  std::span<const Migration> migrations;
};
/// Of this program.
Schema current_schema();

std::filesystem::path store_file(const std::filesystem::path& folder);
/// "DIR: there is no store": the error of whoever looked for one.
[[noreturn]] void no_store(const std::filesystem::path& folder);

/// Makes a new file with the tables and these cells, all of them pending.
void build_store(const std::filesystem::path& file, const StoreIdentity& identity, std::span<const Cell> cells);
/// Puts a finished file in its place; throws InputError when there is one already.
void place_store(const std::filesystem::path& built, const std::filesystem::path& folder);

/// Opens the store, migrating it when it is older and may be written. Throws InputError as Store::open does.
std::unique_ptr<Database> open_database(const std::filesystem::path& folder, Store::Access access,
                                        const Schema& schema = current_schema());

StoreIdentity read_identity(Database& db);

std::string now_text();  ///< UTC, "2026-03-01T12:00:00.000Z"

}  // namespace tarmac::scenarios
