// What the sanitizers do in every program of a sanitizer's build, however it is started: by ctest, by hand,
// or by another program. CMakeLists.txt puts this file into each of them. The environment (ASAN_OPTIONS, …)
// still wins.
//
// The graphics driver (Mesa: llvmpipe, its EGL and the LLVM in it) is not built with sanitizers, keeps its
// compiler for the life of a process, and hands pictures between its own threads in ways that ThreadSanitizer
// cannot see. The test bed that devices are mocked with (umockdev) waits for its thread by GLib's locks,
// which are not built with it either. OpenXR's loader loses 1.5 kB with every instance that is made and
// destroyed (seen with twelve lines that do nothing else, by both compilers). That is all that is suppressed,
// but for one thing in oneTBB's headers (sanitizer_ignore.txt).
//
// Stacks are named by binutils' addr2line, which is there with every compiler (llvm-symbolizer is a package
// of its own).
//
// AddressSanitizer ends a program with 86, ThreadSanitizer with 66: a test that expects a refusal (1) does
// not take one for the other.

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizers' names for them
extern "C" {

const char* __asan_default_options();
const char* __asan_default_options() {
#if defined(__AVX512F__) && !defined(__clang__)
  // GCC 12.2 does not align frames there to the 64 bytes that its own AVX-512 code counts on (its bug
  // 110027): SpinUp.torque_of_a_long_cylinder ended at its first array, and does not without.
  return "allow_addr2line=1:detect_stack_use_after_return=0:strict_string_checks=1:detect_leaks=1:exitcode="
         "86";
#else
  return "allow_addr2line=1:detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1:exitcode="
         "86";
#endif
}

const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() {
  return "leak:libLLVM\n"
         "leak:libopenxr_loader\n"
         "leak:swrast_dri\n"
         "leak:libgallium\n"
         "leak:libEGL_mesa\n"
         "leak:libglapi\n";
}

const char* __ubsan_default_options();
const char* __ubsan_default_options() {
  return "allow_addr2line=1:halt_on_error=1:print_stacktrace=1";
}

const char* __tsan_default_options();
const char* __tsan_default_options() {
  return "allow_addr2line=1:second_deadlock_stack=1";
}

const char* __tsan_default_suppressions();
const char* __tsan_default_suppressions() {
  return "race:libLLVM\n"
         "race:swrast_dri\n"
         "race:libgallium\n"
         "race:libEGL_mesa\n"
         "race:libglapi\n"
         "race:libumockdev\n"
         "race:libglib\n"  // its thread, and how it is called
         "race:libgobject\n"
         "race:libffi\n";
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
