# SPDX-License-Identifier: BSD-2-Clause
# libfap. "make help" says what can be made. Everything is built under build/$(config), so configurations never mix.
# CC, CFLAGS, LDFLAGS, PREFIX and DESTDIR belong to the user; what the project needs lives in FAP_CFLAGS.

config  ?= release
B       := build/$(config)
VERSION := $(shell sed -n 's/.*FAP_VERSION_STRING "\(.*\)"/\1/p' include/fap/version.h)
MAJOR   := $(firstword $(subst ., ,$(VERSION)))
PREFIX  ?= /usr/local
LIBDIR  ?= $(PREFIX)/lib
Q       := $(if $(V),,@)
HOSTCC  ?= cc
PKG     ?= pkg-config
CFLAGS  ?= $(if $(filter asan,$(config)),-O1 -g,-O2 -g)
CXXFLAGS ?= $(CFLAGS)

SAN        := $(if $(filter asan,$(config)),-fsanitize=address -fsanitize=undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
# No fused multiply-add: the same bits on every machine. Nobody asks errno or traps about a square root: loops with one can be
# vectors, with the same bits.
FAP_CFLAGS := -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wshadow -Wmissing-prototypes -Wstrict-prototypes -Wvla -ffp-contract=off \
              -fno-math-errno -fno-trapping-math \
              -fPIC -fvisibility=hidden -Iinclude -Ilib -I. -I$(B) -MMD -MP $(if $(WERROR),-Werror) $(SAN)

# Dear ImGui is C++, and one file of ours speaks to it.
FAP_CXXFLAGS := -std=c++17 -Wall -Wextra -Wshadow -fno-exceptions -fno-rtti -fPIC -fvisibility=hidden -Iinclude -I. -MMD -MP \
                $(if $(WERROR),-Werror) $(SAN)

has = $(shell $(PKG) --exists $(1) 2>/dev/null && echo 1)

# --- what is there ------------------------------------------------------------------------------------------------
# Each outside library is named in exactly one driver; a missing one switches that driver off.
OSMESA  := $(call has,osmesa)
EGL     := $(call has,egl)
PNG     := $(call has,libpng)
SNDFILE := $(call has,sndfile)
SDL2    := $(call has,sdl2)
GLFW    := $(call has,glfw3)
GL      := $(OSMESA)$(EGL)$(GLFW)
IMGUI   := $(if $(GLFW),$(if $(shell command -v $(CXX)),$(call has,imgui)))
# Which libgpiod: v1 (1.6), v2, or none. The two APIs share no call, so each has its file.
GPIO    := $(if $(call has,libgpiod),$(if $(shell $(PKG) --atleast-version=2 libgpiod && echo 1),v2,v1),none)
GPIO_CFLAGS := $(if $(call has,libgpiod),$(shell $(PKG) --cflags libgpiod))
GPIO_LIBS   := $(if $(call has,libgpiod),$(shell $(PKG) --libs libgpiod))
JPEG    := $(call has,libjpeg)
ZLIB    := $(call has,zlib)
CAIRO   := $(call has,cairo)
ESPEAK  := $(call has,espeak-ng)
CMOCKA  := $(call has,cmocka)
# It comes without a .pc file.
EMBREE  := $(shell echo '\#include <embree3/rtcore.h>' | $(CC) -E -x c - >/dev/null 2>&1 && echo 1)

# --- sources ------------------------------------------------------------------------------------------------------
notest    = $(filter-out %_test.c,$(1))
TABLES   := $(wildcard fap_tables/*.csv)
GEN      := $(TABLES:fap_tables/%.csv=$(B)/gen/%.h)
LIB_SRC  := $(call notest,$(wildcard lib/base/*.c lib/param/*.c lib/codec/*.c lib/bank/*.c lib/dsp/*.c lib/dsp/*/*.c lib/live/*.c))
STUDIO_SRC := $(call notest,$(wildcard lib/take/*.c lib/capture/*.c lib/track/*.c lib/speech/*.c lib/shape/*.c lib/registration/*.c) \
              $(filter-out lib/surface/nearest_%,$(wildcard lib/surface/*.c)) lib/surface/nearest_$(if $(EMBREE),embree,none).c)
COMMON_SRC := $(filter-out common/gpio/gpio_%,$(call notest,$(wildcard common/*.c common/*/*.c)))
RENDER_SRC := $(call notest,$(wildcard player/render/*.c))
ENC_SRC  := $(call notest,$(wildcard encoder/*.c encoder/*/*.c))
PLAY_SRC := $(filter-out player/render/%,$(call notest,$(wildcard player/*.c player/*/*.c)))
BANK_SRC := $(call notest,$(wildcard databank/*.c databank/*/*.c))
TEST_SRC := $(wildcard tests/*.c lib/*/*_test.c common/*_test.c common/*/*_test.c encoder/*_test.c encoder/*/*_test.c player/*_test.c player/*/*_test.c databank/*_test.c databank/*/*_test.c \
                       tests/track/*_test.c)
# Films of a face between mirrors, with the truth: for the unit tests, the figures and two programs.
FILM_SRC := $(filter-out tests/track/main_%,$(call notest,$(wildcard tests/track/*.c)))
obj       = $(patsubst %.c,$(B)/%.o,$(1))

STUDIO_LIBS := $(if $(ZLIB),-lz) $(if $(JPEG),-ljpeg)
SHAPE_LIBS  := $(STUDIO_LIBS) $(if $(EMBREE),-lembree3)
RENDER_LIBS := $(if $(OSMESA),-lOSMesa) $(if $(EGL),-lEGL) $(if $(GLFW),-lglfw) $(if $(PNG),-lpng) $(if $(ZLIB),-lz)
PLOT_LIBS   := $(RENDER_LIBS) $(if $(CAIRO),-lcairo)
SOUND_LIBS  := $(if $(SNDFILE),-lsndfile)
PLAY_LIBS   := $(SOUND_LIBS) $(if $(SDL2),-lSDL2) $(GPIO_LIBS) $(if $(IMGUI),$(shell $(PKG) --libs imgui)) $(if $(GLFW),-lglfw) $(if $(IMGUI),-lstdc++)
DEFS     := $(if $(GL),-DHAVE_GL) $(if $(OSMESA),-DHAVE_OSMESA) $(if $(EGL),-DHAVE_EGL) $(if $(PNG),-DHAVE_PNG) $(if $(SNDFILE),-DHAVE_SNDFILE) \
            $(if $(JPEG),-DHAVE_JPEG) $(if $(ZLIB),-DHAVE_ZLIB) $(if $(SDL2),-DHAVE_SDL2) $(if $(GLFW),-DHAVE_GLFW) $(if $(IMGUI),-DHAVE_IMGUI) \
            $(if $(CAIRO),-DHAVE_CAIRO)

TOOLS    := $(B)/fapenc $(B)/fapplay $(B)/fapbank $(if $(ESPEAK),$(B)/fap-phonemes)
LIBS     := $(B)/libfap.a $(B)/libfap-studio.a $(B)/libfap.so.$(VERSION)

# Headers of libraries are not ours to warn about, and one driver file each includes them.
system_cflags = $(patsubst -I%,-isystem %,$(shell $(PKG) --cflags $(1)))
$(B)/player/audio/device_sdl.o: FAP_CFLAGS += $(if $(SDL2),$(call system_cflags,sdl2))
$(B)/common/canvas/canvas_cairo.o: FAP_CFLAGS += $(if $(CAIRO),$(call system_cflags,cairo))
$(B)/player/window/panel_imgui.o: FAP_CXXFLAGS += $(if $(IMGUI),$(call system_cflags,imgui))

COMPILE   = mkdir -p $(@D) && $(CC) $(FAP_CFLAGS) $(DEFS) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<
LINK      = mkdir -p $(@D) && $(CC) $(SAN) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o %.a,$^)
SAY       = $(if $(V),,@echo "  $(1) $@")

.PHONY: all help setup face test check unit cli demo bench asan fuzz cross coverage install clean docs format
all: $(LIBS) $(TOOLS)

# --- tables and objects --------------------------------------------------------------------------------------------
$(B)/gen/csv2c: fap_tables/csv2c.c
	$(Q)mkdir -p $(@D) && $(HOSTCC) -O1 -o $@ $<
$(B)/gen/%.h: fap_tables/%.csv $(B)/gen/csv2c
	$(Q)$(B)/gen/csv2c $< $* $@
$(B)/%.o: %.c | $(GEN)
	$(call SAY,CC)
	$(Q)$(COMPILE)

$(B)/%.o: %.cpp | $(GEN)
	$(call SAY,CXX)
	$(Q)mkdir -p $(@D) && $(CXX) $(FAP_CXXFLAGS) $(DEFS) $(CPPFLAGS) $(CXXFLAGS) -c -o $@ $<

# --- libraries -----------------------------------------------------------------------------------------------------
$(B)/libfap.a: $(call obj,$(LIB_SRC))
$(B)/libfap-studio.a: $(call obj,$(STUDIO_SRC))
$(B)/libfap-common.a: $(call obj,$(COMMON_SRC))
$(B)/libfap-gpio-$(GPIO).a: $(B)/common/gpio/gpio_$(GPIO).o
$(B)/common/gpio/gpio_$(GPIO).o: FAP_CFLAGS += $(GPIO_CFLAGS)
$(B)/libfap-render.a: $(call obj,$(RENDER_SRC))
$(B)/libfap-film.a: $(call obj,$(FILM_SRC))
$(B)/%.a:
	$(call SAY,AR)
	$(Q)mkdir -p $(@D) && rm -f $@ && $(AR) rcs $@ $^
$(B)/libfap.so.$(VERSION): $(call obj,$(LIB_SRC))
	$(call SAY,LD)
	$(Q)$(CC) $(SAN) -shared -Wl,-soname,libfap.so.$(MAJOR) $(LDFLAGS) -o $@ $^ -lm

# --- tools ---------------------------------------------------------------------------------------------------------
BASE := $(B)/libfap-common.a $(B)/libfap-gpio-$(GPIO).a $(B)/libfap-studio.a $(B)/libfap.a
# Everything of a tool but main: the unit tests link it too.
$(B)/libfap-enc.a: $(call obj,$(filter-out encoder/main.c,$(ENC_SRC)))
$(B)/fapenc: $(B)/encoder/main.o $(B)/libfap-enc.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(PLOT_LIBS) $(SOUND_LIBS) $(STUDIO_LIBS) $(GPIO_LIBS) -lm
$(B)/libfap-play.a: $(call obj,$(filter-out player/main.c,$(PLAY_SRC))) $(if $(IMGUI),$(B)/player/window/panel_imgui.o)
$(B)/fapplay: $(B)/player/main.o $(B)/libfap-play.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(RENDER_LIBS) $(PLAY_LIBS) $(STUDIO_LIBS) -lm
$(B)/libfap-databank.a: $(call obj,$(filter-out databank/main.c,$(BANK_SRC)))
$(B)/fapbank: $(B)/databank/main.o $(B)/libfap-databank.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(PLOT_LIBS) $(SHAPE_LIBS) -lm

# A program of its own, under espeak-ng's licence (phonemes/README.md): nothing else links that library.
$(B)/fap-phonemes: $(B)/phonemes/fap_phonemes.o $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(shell $(PKG) --libs espeak-ng)

# --- tests ---------------------------------------------------------------------------------------------------------
FUZZ     := $(patsubst tests/fuzz/%.c,%,$(filter-out tests/fuzz/replay.c,$(wildcard tests/fuzz/*.c)))
REPLAY   := $(FUZZ:%=$(B)/replay/%)
ALL_LIBS := $(PLOT_LIBS) $(PLAY_LIBS) $(SHAPE_LIBS) -lm

$(B)/mirror-film $(B)/mirror-compare $(B)/mirror-study: $(B)/mirror-%: $(B)/tests/track/main_%.o $(B)/libfap-film.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(STUDIO_LIBS) -lm
$(B)/unit: $(call obj,$(TEST_SRC)) $(B)/libfap-film.a $(B)/libfap-enc.a $(B)/libfap-play.a $(B)/libfap-databank.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) -lcmocka $(ALL_LIBS)
$(B)/replay/%: $(B)/tests/fuzz/%.o $(B)/tests/fuzz/replay.o $(B)/libfap-databank.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(ALL_LIBS)

$(B)/fapenc $(B)/fapplay $(B)/fapbank $(B)/fapplay-lines: $(if $(SAN),$(B)/tests/asan/dlclose.o)
# fapplay with lines that are files: tests/cli/window_lines.sh.
$(B)/fapplay-lines: $(B)/player/main.o $(B)/tests/gpio/files.o $(B)/libfap-play.a $(B)/libfap-render.a $(filter-out $(B)/libfap-gpio-%,$(BASE))
	$(call SAY,LD)
	$(Q)$(LINK) $(RENDER_LIBS) $(PLAY_LIBS) $(STUDIO_LIBS) -lpthread -lm

# Streams written field by field (docs/conformance.md). Needs no cmocka: it runs wherever libfap does.
CONF_SRC := $(wildcard tests/conformance/*.c)
$(B)/conformance: $(call obj,$(CONF_SRC)) $(B)/libfap.a
	$(call SAY,LD)
	$(Q)$(LINK) -lm

# The codec without faces and kernels, for machines of other kinds: tests/cross/run.
CODEC_SRC := $(filter-out lib/codec/ascii% lib/codec/fit_%,$(call notest,$(wildcard lib/base/*.c lib/param/*.c lib/codec/*.c))) \
             lib/bank/sensitivity.c
$(B)/libfap-codec.a: $(call obj,$(CODEC_SRC))
CROSS_LIB ?= $(B)/libfap-codec.a
$(B)/cross-conformance: $(call obj,$(CONF_SRC)) $(CROSS_LIB)
	$(call SAY,LD)
	$(Q)$(LINK) -lm
$(B)/cross-encode: $(B)/tests/cross/encode.o $(CROSS_LIB)
	$(call SAY,LD)
	$(Q)$(LINK) -lm
cross:             ## conformance and the encoder's bytes on other machines (qemu) and with other flags: all alike
	$(Q)tests/cross/run

# Objects of gcc's coverage build count what ran; gcovr reads them.
coverage:          ## which lines and branches of the codec the unit and conformance tests take; every one of the decoder
	$(Q)command -v gcovr >/dev/null || { echo "coverage: install gcovr (apt-get install gcovr)" >&2; exit 3; }
	+$(Q)$(MAKE) --no-print-directory config=coverage CC=gcc CFLAGS="-O0 -g --coverage" LDFLAGS=--coverage \
	    build/coverage/unit build/coverage/conformance
	$(Q)find build/coverage -name '*.gcda' -delete
	$(Q)build/coverage/conformance tests/conformance/fba/*.syntax tests/conformance/fba/bad/*.syntax
	$(Q)build/coverage/unit >build/coverage/unit.log 2>&1 || { tail -n 20 build/coverage/unit.log; exit 1; }
	$(Q)gcovr -r . --object-directory build/coverage -f lib/codec/ -f lib/param/ --json build/coverage/coverage.json \
	    build/coverage/lib/codec build/coverage/lib/param
	$(Q)tests/conformance/coverage.py build/coverage/coverage.json

setup:             ## install the Debian packages that are missing (scripts/packages.txt)
	$(Q)scripts/setup

test: setup        ## install what is missing, build, run every test
	+$(Q)$(MAKE) --no-print-directory config=$(config) check
check: all face $(B)/unit $(B)/mirror-film $(B)/mirror-compare $(B)/fapplay-lines $(B)/conformance $(REPLAY) $(B)/examples
	$(Q)B=$(B) tests/run
unit: $(B)/unit    ## unit tests alone
	$(Q)$(B)/unit
asan: setup        ## every test under the address and undefined-behaviour sanitizers
	+$(Q)$(MAKE) --no-print-directory config=asan check

# The documentation's examples must compile against the installed face of the library: headers and libfap.a alone.
EXAMPLES := $(wildcard docs/examples/*.c)
$(B)/examples: $(EXAMPLES) $(B)/libfap.a
	$(Q)mkdir -p $@
	$(Q)for e in $(EXAMPLES); do $(CC) -std=c11 -Wall -Wextra -Werror $(SAN) -Iinclude -o $@/$$(basename $$e .c) $$e $(B)/libfap.a -lm || exit 1; done
	$(Q)touch $@

# libFuzzer builds have their own configuration: everything with clang and coverage.
FUZZ_CC   ?= clang-14
FUZZ_TIME ?= 60
fuzz:              ## run every fuzz target for FUZZ_TIME seconds (needs clang)
	+$(Q)$(MAKE) --no-print-directory config=fuzz CC=$(FUZZ_CC) SAN="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined" CFLAGS="-O1 -g" fuzz-targets
	$(Q)for t in $(FUZZ); do echo "fuzz $$t"; mkdir -p build/fuzz/found/$$t; \
	    build/fuzz/fuzz/$$t -max_total_time=$(FUZZ_TIME) -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 -verbosity=0 \
	        -artifact_prefix=build/fuzz/found/$$t/ build/fuzz/found/$$t tests/fuzz/corpus/$$t || exit 1; done
fuzz-targets: $(FUZZ:%=$(B)/fuzz/%)
$(B)/fuzz/%: $(B)/tests/fuzz/%.o $(B)/libfap-databank.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)mkdir -p $(@D) && $(CC) -fsanitize=fuzzer,address,undefined $(CFLAGS) -o $@ $(filter %.o %.a,$^) $(ALL_LIBS)

# --- face, demo, figures -------------------------------------------------------------------------------------------
face: $(B)/fapbank ## build the default face (build/default.fbank)
	$(Q)FAPBANK=$(B)/fapbank scripts/make_face build/default.fbank

demo: setup        ## a spoken sentence, from optical markers to a film: build/demo.mp4, build/demo.png
	+$(Q)$(MAKE) --no-print-directory all face
	$(Q)B=$(B) scripts/demo

BENCH_SRC := $(wildcard tests/bench/*.c)
# How small the decoder is, here and on 64-bit Arm.
ARM64_CC  ?= aarch64-linux-gnu-gcc
$(B)/gen/decoder_size.h: scripts/decoder_size include/fap/decoder.h $(B)/libfap.a
	$(Q)size() { scripts/decoder_size $$1 $(filter-out -M%,$(FAP_CFLAGS)); }; \
	    echo "enum { DECODER_SIZE = $$(size "$(CC)"), DECODER_SIZE_ARM64 = $$(size "$(ARM64_CC)") };" >$@
$(B)/tests/bench/fba.o: $(B)/gen/decoder_size.h
$(B)/bench: $(call obj,$(BENCH_SRC)) $(B)/libfap-film.a $(B)/libfap-enc.a $(B)/libfap-play.a $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(ALL_LIBS)
bench: setup       ## the figures: one a line, and build/bench.json
	+$(Q)$(MAKE) --no-print-directory all face $(B)/bench
	$(Q)$(B)/bench build/bench.json

# The demo take is committed; this makes it again. Links espeak-ng (GPL), so it is no part of the product.
$(B)/make_demo_take: tests/assets/make_demo_take.c $(BASE)
	$(Q)mkdir -p $(@D) && $(CC) $(FAP_CFLAGS) $(CFLAGS) -o $@ $< $(BASE) -lespeak-ng -lsndfile $(STUDIO_LIBS) -lm
demo-take: $(B)/make_demo_take face
	$(Q)$(B)/make_demo_take build/default.fbank tests/assets/demo_take.c3d tests/assets/demo_take.wav

# --- install -------------------------------------------------------------------------------------------------------
D := $(DESTDIR)
install: all       ## into DESTDIR, PREFIX: libfap, headers, tools, man pages, libfap.pc, the default face when it is built
	install -d $(D)$(PREFIX)/bin $(D)$(LIBDIR)/pkgconfig $(D)$(PREFIX)/include/fap/studio $(D)$(PREFIX)/share/man/man1 $(D)$(PREFIX)/share/libfap
	install -m 755 $(TOOLS) $(D)$(PREFIX)/bin
	install -m 644 include/fap/*.h $(D)$(PREFIX)/include/fap
	install -m 644 include/fap/studio/*.h $(D)$(PREFIX)/include/fap/studio
	install -m 644 $(B)/libfap.a $(B)/libfap-studio.a $(D)$(LIBDIR)
	install -m 755 $(B)/libfap.so.$(VERSION) $(D)$(LIBDIR)
	ln -sf libfap.so.$(VERSION) $(D)$(LIBDIR)/libfap.so.$(MAJOR)
	ln -sf libfap.so.$(MAJOR) $(D)$(LIBDIR)/libfap.so
	install -m 644 docs/man/*.1 $(D)$(PREFIX)/share/man/man1
	if [ -f build/default.fbank ]; then install -m 644 build/default.fbank $(D)$(PREFIX)/share/libfap; fi
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|' scripts/libfap.pc.in >$(D)$(LIBDIR)/pkgconfig/libfap.pc

help:              ## this list
	@sed -n 's/^\([a-z-]*\):.*## */\1\t/p' $(MAKEFILE_LIST) | expand -t 12
	@echo "config=asan builds with sanitizers, V=1 shows commands, WERROR=1 makes warnings errors"
clean:             ## remove everything that was built
	rm -rf build

.PHONY: fuzz-targets demo-take
.DELETE_ON_ERROR:
.SECONDARY:
-include $(shell find $(B) -name '*.d' 2>/dev/null)
