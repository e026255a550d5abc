// Starts the tests again with umockdev's library in front of the C library's, so that a driver opens what the
// test made and not the machine's own devices. With AddressSanitizer its library must come first.
// A test that waits for ever for a made-up device ends here, with its name, and not the whole suite with it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

#ifdef SLOSH_SANITIZED
constexpr unsigned kLongest = 1200;
#else
constexpr unsigned kLongest = 120;  // s of one test, which takes 2
#endif

class EndsHanging : public ::testing::EmptyTestEventListener {
  void OnTestStart(const ::testing::TestInfo&) override { alarm(kLongest); }
  void OnTestEnd(const ::testing::TestInfo&) override { alarm(0); }
};

extern "C" void end_hanging(int) {
  constexpr char kWords[] = "The test above hung and was ended\n";
  (void)!write(STDERR_FILENO, kWords, sizeof kWords - 1);
  _exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kMark = "SLOSH_UNDER_UMOCKDEV";
  if (std::getenv(kMark) == nullptr) {
    setenv(kMark, "1", 1);
#ifdef __SANITIZE_ADDRESS__  // g++: its runtime is a library that insists on being the first; clang's is in
                             // the program
    setenv("LD_PRELOAD", "libasan.so.8:libumockdev-preload.so.0", 1);
#else
    setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
#endif
    execv("/proc/self/exe", argv);
    std::perror("the tests cannot start themselves again");
    return 1;
  }
  ::testing::InitGoogleTest(&argc, argv);
  std::signal(SIGALRM, end_hanging);
  ::testing::UnitTest::GetInstance()->listeners().Append(new EndsHanging);
  return RUN_ALL_TESTS();
}
