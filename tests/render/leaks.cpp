// The software GL driver keeps its compiler for the life of the process; LeakSanitizer sees that as leaks.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the sanitizer's name for it
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libLLVM\n"
         "leak:swrast_dri\n"
         "leak:libgallium\n"
         "leak:libEGL_mesa\n"
         "leak:libglapi\n";
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
