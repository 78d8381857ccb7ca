#include "exitance/base/version.hpp"
#include "exitance/cli/reference/pages.hpp"
#include "exitance/cli/verbs.hpp"

namespace exitance {
namespace {

std::string page(ReferenceFormat format) {
    const std::vector<VerbFacts> facts = facts_of_verbs();
    switch (format) {
        case ReferenceFormat::man:
            return man_page(facts, program_version);
        case ReferenceFormat::markdown:
            return markdown_page(facts);
        case ReferenceFormat::bash:
            return bash_completion(facts);
        case ReferenceFormat::zsh:
            return zsh_completion(facts);
        case ReferenceFormat::list:
            return option_list(facts);
    }
    return "";
}

}  // namespace

/// Runs `exitance reference --format FORMAT`.
ExitCode run(const ReferenceArguments& arguments, Terminal& terminal) {
    terminal.print(page(arguments.format));
    return ExitCode::done;
}

}  // namespace exitance
