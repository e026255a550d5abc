// The software GL driver keeps its compiler for the life of the process; LeakSanitizer sees that as leaks.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libLLVM\n"
         "leak:swrast_dri\n"
         "leak:libgallium\n"
         "leak:libEGL_mesa\n"
         "leak:libglapi\n";
}
