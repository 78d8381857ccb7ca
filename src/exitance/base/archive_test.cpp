#include "exitance/base/archive.hpp"

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

TEST(Archive, ReadsBackWhatWasWritten) {
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

TEST(Archive, WhatIsDealtOutComesTogetherAgain) {
    std::vector<int> in(3 * DealtBytes::block / sizeof(int) + 5);
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<int>(i);
    std::string name = "room";
    ArchiveWriter whole;
    whole(name, in);
    const std::size_t size = whole.size();
    const std::string bytes = whole.take();
    EXPECT_EQ(size, bytes.size());
    for (std::size_t of : {1, 2, 3, 7}) {
        std::vector<std::string> dealt;
        for (std::size_t own = 0; own < of; ++own) {
            ArchiveWriter writer({own, of});
            writer(name, in);
            EXPECT_EQ(writer.size(), size);
            dealt.push_back(writer.take());
        }
        EXPECT_TRUE(put_together(dealt) == bytes) << of;
        dealt[0] += dealt[0];
        EXPECT_TRUE(of == 1 || put_together(dealt).empty()) << of;
    }
}

TEST(Archive, TruncatedInputIsDetectedAndAllocatesNothing) {
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
    std::uint64_t huge_count = ~std::uint64_t(0);
    ArchiveWriter writer_of_count;
    writer_of_count(huge_count);
    const std::string damaged = writer_of_count.take();
    ArchiveReader reader(damaged);
    std::vector<double> values;
    reader(values);
    EXPECT_TRUE(values.empty());
    EXPECT_FALSE(reader.good());
}

}  // namespace exitance
