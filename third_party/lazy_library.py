#!/usr/bin/env python3
"""Writes a C file whose functions stand for those of a shared library, which is loaded when the first of them is called.
In: the library, the file to write, and a regular expression for the mangled names wanted. x86-64 Linux only.

Each function is a jump through a slot. At first the slot leads to bind_first_call, which keeps the registers that carry
arguments, asks bind() for the address and puts it into the slot. Data of the library cannot be had in this way: what
needs it does not link."""
import re
import subprocess
import sys

HEAD = r'''// Made by third_party/lazy_library.py.
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

struct slot { void* function; const char* name; };
static void* library;

static void fail(void) {
    fprintf(stderr, "astrosplat: %s\n", dlerror());
    _exit(1);
}
static void load(void) {
    library = dlopen("@SONAME@", RTLD_LAZY | RTLD_LOCAL);
    if (!library) fail();
}
__attribute__((used)) static void astrosplat_bind(struct slot* slot) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, load);
    void* function = dlsym(library, slot->name);
    if (!function) fail();
    __atomic_store_n(&slot->function, function, __ATOMIC_RELEASE);
}
__asm__(
    ".text\n"
    "bind_first_call:\n"  // r11: the slot
    "  push %rbp\n  mov %rsp, %rbp\n"
    "  push %rax\n  push %rdi\n  push %rsi\n  push %rdx\n  push %rcx\n  push %r8\n  push %r9\n  push %r10\n  push %r11\n"
    "  sub $136, %rsp\n"
    "  movups %xmm0, (%rsp)\n  movups %xmm1, 16(%rsp)\n  movups %xmm2, 32(%rsp)\n  movups %xmm3, 48(%rsp)\n"
    "  movups %xmm4, 64(%rsp)\n  movups %xmm5, 80(%rsp)\n  movups %xmm6, 96(%rsp)\n  movups %xmm7, 112(%rsp)\n"
    "  mov %r11, %rdi\n  call astrosplat_bind\n"
    "  movups (%rsp), %xmm0\n  movups 16(%rsp), %xmm1\n  movups 32(%rsp), %xmm2\n  movups 48(%rsp), %xmm3\n"
    "  movups 64(%rsp), %xmm4\n  movups 80(%rsp), %xmm5\n  movups 96(%rsp), %xmm6\n  movups 112(%rsp), %xmm7\n"
    "  add $136, %rsp\n"
    "  pop %r11\n  pop %r10\n  pop %r9\n  pop %r8\n  pop %rcx\n  pop %rdx\n  pop %rsi\n  pop %rdi\n  pop %rax\n"
    "  pop %rbp\n"
    "  jmp *(%r11)\n");
#define LAZY(n, name)                                                     \
    __asm__(".text\n.globl " name "\n.hidden " name "\n.type " name ", @function\n" name ": jmp *slot_" #n "(%rip)\n" \
            "first_" #n ": lea slot_" #n "(%rip), %r11\n  jmp bind_first_call\n"                          \
            ".section .rodata\nname_" #n ": .asciz \"" name "\"\n"                                         \
            ".data\n.balign 8\nslot_" #n ": .quad first_" #n ", name_" #n "\n.text\n");
'''

library, output, pattern = sys.argv[1:4]
soname = re.search(r"SONAME\).*\[(.*)\]", subprocess.check_output(["readelf", "-d", library], text=True)).group(1)
names = []
for line in subprocess.check_output(["nm", "--dynamic", "--defined-only", "--format=posix", library], text=True).splitlines():
    name, kind = line.split()[:2]
    if kind == "T" and re.search(pattern, name):
        names.append(name.split("@")[0])
if not names:
    sys.exit(f"{library}: no function is called {pattern}")
with open(output, "w") as file:
    file.write(HEAD.replace("@SONAME@", soname))
    file.writelines(f'LAZY({n}, "{name}")\n' for n, name in enumerate(sorted(names)))
