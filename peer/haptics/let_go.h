// No way out of this process leaves a hand with a force: who writes wrenches, and how all of them are ended.
#pragma once

namespace slosh {

/// One for as long as a thread writes wrenches, on that thread. `write_zero(of)` ends the thread's devices
/// with a wrench of zero; it is called on that thread when std::terminate is (an exception that nobody
/// caught), before the process dies.
class WrenchWriter {
 public:
  using WriteZero = void (*)(void* of) noexcept;
  WrenchWriter(WriteZero write_zero, void* of) noexcept;
  ~WrenchWriter();
  WrenchWriter(const WrenchWriter&) = delete;
  WrenchWriter& operator=(const WrenchWriter&) = delete;

  void zero() const noexcept { write_zero_(of_); }

 private:
  WriteZero write_zero_;
  void* of_;
};

/// Every thread that writes wrenches asks once a period: true = write zero and end.
bool asked_to_let_go() noexcept;

/// Asks all of them and waits until they have, for `seconds` at most (> 0): a device that does not answer
/// must not keep the process. For good: nothing is written after this. Safe in a signal's handler.
void let_go_of_all_hands(double seconds) noexcept;

/// s that a dying process waits for its hands: some hundred periods of the device loop.
constexpr double kLetGoWithin = 0.2;

/// From now on std::terminate lets go of all hands first, and so does a crash (a fault in any thread, abort):
/// the process dies of it all the same. Called by whoever starts the first writer.
void let_go_before_the_end() noexcept;

}  // namespace slosh
