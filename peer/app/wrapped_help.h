// How --help is set: what an option is for, in lines of a width that terminals have.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace slosh {

/// `text` in lines of at most `width` bytes where its words allow; breaks that it has are not kept.
std::string wrapped(const std::string& text, std::size_t width);

/// CLI11's own, its column of explanations wrapped.
class WrappedHelp : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace slosh
