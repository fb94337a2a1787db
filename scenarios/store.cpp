// Making, opening and closing a store.
#include "scenarios/store.h"

#include <fmt/format.h>
#include <unistd.h>

#include "core/error.h"
#include "core/files.h"
#include "scenarios/store_schema.h"
#include "scenarios/store_state.h"

namespace tarmac::scenarios {
namespace fs = std::filesystem;

Store::Store() : state_(std::make_unique<State>()) {}
Store::Store(Store&&) noexcept = default;

Store& Store::operator=(Store&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Store::~Store() {
  // A forked child that ends must not end what is its parent's: not even by closing the connection.
  if (state_ && state_->opened_by != ::getpid()) {
    static_cast<void>(state_.release());
    return;
  }
  if (state_) state_->end_run();
}

Store Store::create(const fs::path& folder, const StoreIdentity& identity, const std::string& sweep_text,
                    std::span<const Cell> cells) {
  if (fs::exists(store_file(folder)))
    throw core::InputError(fmt::format(
        "{}: there is a store already; go on with it by --resume, or choose another folder", folder.string()));
  {
    const WriterLock lock(folder / "work");
    build_store(lock.folder() / "store.sqlite", identity, cells);
    core::write_file(folder / "sweep.yaml", sweep_text);
    place_store(lock.folder() / "store.sqlite", folder);
  }
  return open(folder, Access::read_write);
}

Store Store::open(const fs::path& folder, Access access) {
  Store store;
  State& s = *store.state_;
  s.folder = folder;
  s.opened_by = ::getpid();
  s.db = open_database(folder, access);
  s.identity = read_identity(*s.db);
  return store;
}

const StoreIdentity& Store::identity() const {
  return state_->identity;
}

const fs::path& Store::folder() const {
  return state_->folder;
}

}  // namespace tarmac::scenarios
