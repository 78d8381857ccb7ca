#pragma once

#include <span>
#include <string>

#include "exitance/cli/reference/verb_facts.hpp"

namespace exitance {

/// Text of `exitance VERB --help` or, with the options of all audiences, of `--help-all`.
std::string help_page(const VerbFacts& verb, bool all);

/// Markdown page with all options of all verbs (docs/options.md).
std::string markdown_page(std::span<const VerbFacts> verbs);

/// Manual page for `man`. `version`: version of the program.
std::string man_page(std::span<const VerbFacts> verbs, const std::string& version);

/// Script for bash that completes verbs, options and their values.
std::string bash_completion(std::span<const VerbFacts> verbs);

/// Script for zsh that completes verbs, options and their values.
std::string zsh_completion(std::span<const VerbFacts> verbs);

/// A line per option: verb, option, type, group and audience, separated by tabs.
std::string option_list(std::span<const VerbFacts> verbs);

}  // namespace exitance
