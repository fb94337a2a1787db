#include "sim/lidar/firing_grid.h"

#include <gtest/gtest.h>

#include <set>

namespace tarmac::sim::lidar {
namespace {

TEST(FiringGrid, EveryFiringOfEverySensorHasACellOfItsOwn) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    const FiringTable firing(p, mode_of(p, 0, 0));
    const SweepSpan span = firing.sweep(3);
    const FiringGrid grid(firing, 3);
    EXPECT_EQ(grid.begin(), span.begin);
    EXPECT_EQ(grid.rings(), p.channels()) << name;
    EXPECT_EQ(grid.columns(), static_cast<std::size_t>(span.cycles) * firing.blocks());
    const std::vector<std::int64_t> column_ns = grid.column_times_ns();
    ASSERT_EQ(column_ns.size(), grid.columns());
    std::set<std::pair<std::size_t, std::size_t>> taken;
    for (const std::int64_t k : {std::int64_t{0}, span.cycles / 2, span.cycles - 1})
      for (std::size_t c = 0; c < firing.channels(); ++c) {
        const std::int64_t t_ns = (firing.cycle(span, k).t - span.begin).count() + firing.offset_ns(c);
        const auto cell = grid.cell(firing.ring(c), t_ns);
        ASSERT_TRUE(cell) << name;
        EXPECT_EQ(cell->ring, p.ring[firing.channel_of(c)]);
        EXPECT_EQ(cell->column, static_cast<std::size_t>(k) * firing.blocks() + firing.block_of(c));
        EXPECT_LE(column_ns[cell->column], t_ns);
        EXPECT_TRUE(taken.insert({cell->ring, cell->column}).second) << name << ": two firings share a cell";
        EXPECT_FALSE(grid.cell(firing.ring(c), t_ns + 1)) << name;
      }
    EXPECT_FALSE(grid.cell(static_cast<std::uint16_t>(p.channels()), 0));
  }
}

}  // namespace
}  // namespace tarmac::sim::lidar
