// Starts the tests again with umockdev's library in front of the C library's, so that a driver opens what the
// test made and not the machine's own devices. With AddressSanitizer its library must come first.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  constexpr const char* kMark = "SLOSH_UNDER_UMOCKDEV";
  if (std::getenv(kMark) == nullptr) {
    setenv(kMark, "1", 1);
#ifdef __SANITIZE_ADDRESS__
    setenv("LD_PRELOAD", "libasan.so.8:libumockdev-preload.so.0", 1);
#else
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
#endif
    execv("/proc/self/exe", argv);
    std::perror("the tests cannot start themselves again");
    return 1;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
