#include "exitance/processes/result_of_all.hpp"

#include <gtest/gtest.h>

#include "exitance/processes/exchange_archived.hpp"
#include "exitance/processes/run_apart.hpp"

namespace exitance {

TEST(ResultOfAll, ASingleProcessKeepsItsOwnResult) {
    EXPECT_TRUE(result_of_all({}));
    const Result<void> failed = result_of_all(Error{ErrorCode::limit, "too much", "here", "less"});
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "too much");
    const Result<std::string> value = all_or_none(Result<std::string>(std::string("word")));
    ASSERT_TRUE(value);
    EXPECT_EQ(*value, "word");
}

TEST(ExchangeArchived, ASingleProcessKeepsItsValues) {
    std::vector<std::string> words{"one", "two"};
    const auto archive_word = [](auto& archive, std::string& word) { archive(word); };
    exchange_archived(std::span(words), 1, archive_word, "test");
    EXPECT_EQ(words, (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(as_first_archived(std::string("one"), archive_word, "test"), "one");
}

TEST(RunApart, TheWorkRunsOnce) {
    int runs = 0;
    run_apart([&] {
        ++runs;
        EXPECT_EQ(processes(), 1u);
        EXPECT_TRUE(is_first_process());
    });
    EXPECT_EQ(runs, 1);
}

}  // namespace exitance
