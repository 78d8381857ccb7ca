#include "exitance/core/archive.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

struct Thing {
    std::string name;
    std::vector<std::vector<int>> lists;
    std::optional<std::vector<double>> maybe, absent;
    std::map<std::string, double> seconds;
    Field<Id<Thing>, float> field;
};

template <class Archive>
void archive(Archive& a, Thing& thing) {
    a(thing.name, thing.lists, thing.maybe, thing.absent, thing.seconds, thing.field);
}

Thing sample() {
    return {"room",
            {{1, 2}, {}, {3}},
            std::vector<double>{0.1, -0.0},
            {},
            {{"link", 0.5}, {"mesh", 2}},
            Field<Id<Thing>, float>(3, 7)};
}

}  // namespace

TEST(Archive, GivesBackWhatWasPutIn) {
    Thing in = sample(), out;
    out.absent = {1.0};
    ArchiveWriter writer;
    writer(in);
    const std::string bytes = writer.take();
    ArchiveReader reader(bytes);
    reader(out);
    EXPECT_TRUE(reader.good());
    EXPECT_EQ(reader.left(), 0u);
    EXPECT_EQ(out.name, in.name);
    EXPECT_EQ(out.lists, in.lists);
    EXPECT_EQ(out.maybe, in.maybe);
    EXPECT_EQ(out.absent, in.absent);
    EXPECT_EQ(out.seconds, in.seconds);
    EXPECT_EQ(out.field.size(), 3u);
}

TEST(Archive, WhatIsCutShortIsNoticedAndTakesNoMemory) {
    Thing in = sample();
    ArchiveWriter writer;
    writer(in);
    const std::string bytes = writer.take();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        ArchiveReader reader(std::string_view(bytes).substr(0, size));
        Thing out;
        reader(out);
        EXPECT_LE(out.lists.size(), 3u);
        EXPECT_LE(out.field.size(), 3u);
    }
    std::uint64_t much = ~std::uint64_t(0);
    ArchiveWriter lie;
    lie(much);
    const std::string lies = lie.take();
    ArchiveReader reader(lies);
    std::vector<double> values;
    reader(values);
    EXPECT_TRUE(values.empty());
    EXPECT_FALSE(reader.good());
}

}  // namespace exitance
