// What a fuzz target may give besides LLVMFuzzerTestOneInput.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// Inputs to begin with: valid ones, made by the encoder, so that nothing bulky lies in the repository. The
/// same every time. A target that has none leaves it out.
std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds();

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
