// glyphs.cpp — outlines taken from DejaVu Sans, flattened to polygons on a grid of 1/72 em.
//
// DejaVu's changes are in the public domain; the outlines that they build on have this notice:
//
// Copyright (c) 2003 by Bitstream, Inc. All Rights Reserved. Bitstream Vera is a trademark of Bitstream, Inc.
//
// Permission is hereby granted, free of charge, to any person obtaining a copy of the fonts accompanying this
// license
// ("Fonts") and associated documentation files (the "Font Software"), to reproduce and distribute the Font
// Software, including without limitation the rights to use, copy, merge, publish, distribute, and/or sell copies of
// the Font Software, and to permit persons to whom the Font Software is furnished to do so, subject to the
// following conditions:
//
// The above copyright and trademark notices and this permission notice shall be included in all copies of one or
// more of the Font Software typefaces.
//
// The Font Software may be modified, altered, or added to, and in particular the designs of glyphs or characters in
// the Fonts may be modified and additional glyphs or characters may be added to the Fonts, only if the fonts are
// renamed to names not containing either the words "Bitstream" or the word "Vera".
//
// This License becomes null and void to the extent applicable to Fonts or Font Software that has been modified and
// is distributed under the "Bitstream Vera" names.
//
// The Font Software may be sold as part of a larger software package but no copy of one or more of the Font
// Software typefaces may be sold by itself.
//
// THE FONT SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT
// LIMITED TO ANY WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT OF COPYRIGHT,
// PATENT, TRADEMARK, OR OTHER RIGHT. IN NO EVENT SHALL BITSTREAM OR THE GNOME FOUNDATION BE LIABLE FOR ANY CLAIM,
// DAMAGES OR OTHER LIABILITY, INCLUDING ANY GENERAL, SPECIAL, INDIRECT, INCIDENTAL, OR CONSEQUENTIAL DAMAGES,
// WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF THE USE OR INABILITY TO USE THE FONT
// SOFTWARE OR FROM OTHER DEALINGS IN THE FONT SOFTWARE.
//
// Except as contained in this notice, the names of Gnome, the Gnome Foundation, and Bitstream Inc., shall not be
// used in advertising or otherwise to promote the sale, use or other dealings in this Font Software without prior
// written authorization from the Gnome Foundation or Bitstream Inc., respectively.
#include "picture/glyphs.hpp"

namespace molmesh::picture {
namespace {

// clang-format off
constexpr Glyph glyphs[] = {
    {0x20, 22.9, R"()"},
    {0x21, 28.9, R"(9B@B@999 9m@m@V?J:J9V)"},
    {0x22, 33.1, R"(;m;Z5Z5m HmHZBZBm)"},
    {0x23, 60.3, R"(SYIYFMPM NmJ^T^Xm]mZ^e^eYXYVMaMaHTHQ9K9OHDHA9;9?H4H4M@MCY8Y8^D^Hm)"},
    {0x24, 45.8, R"(F.C.C9;:4<4C;?C>CN<P8R4[5`8d<fCgCpFpFhMgSeS_MaFbFSMRROVFUAR=M:F9 CTCb=`:[<V FMF>MAOFMK)"},
    {0x25, 68.4, R"(bP^M\F^?b<g?iFgM bUgTkQnLnFn@k<g9b8]9Y<W@VFWLYQ]T >j9g8`9Y>VCYE`Cg ^ncnC8=8 >nCmGkIfJ`IZGVCS>R9S5V3Z2`3f5k9m)"},
    {0x26, 56.1, R"(@U;P9J=AA?F>M?RB DYVGZN[UaU_LZCd9[9V>N:F8>98=4B3I5R<Y9^9b9g<kAnGnMnRlRfMhGiAg?b@^)"},
    {0x27, 19.8, R"(;m;Z5Z5m)"},
    {0x28, 28.1, R"(DpAj?e=`<X;P<H=@?:A5D0?0;59:7@5H4P5W7_9e;j?p)"},
    {0x29, 28.1, R"(4p9p=j?eA_CWDPCHA@?:=59040759:;@<H=P<X;`9e7j)"},
    {0x2a, 36, R"(PeC^PWNTB[BN>N>[2T0W=^0e2h>a>nBnBaNh)"},
    {0x2b, 60.3, R"(OfOScScMOMO9I9IM6M6SISIf)"},
    {0x2c, 22.9, R"(6B>B><81416<)"},
    {0x2d, 26, R"(2PDPDJ2J)"},
    {0x2e, 22.9, R"(6B=B=969)"},
    {0x2f, 24.3, R"(@mFm42.2)"},
    {0x30, 45.8, R"(Ei@g=c;]:S;J=C@?E>J?MCOJPSO]McJg EnMmRgUbW[WSWKUDR?M:E8=:7?5D3K3S3[5b7g=m)"},
    {0x31, 45.8, R"(7?C?Cg6d6kBmJmJ?U?U979)"},
    {0x32, 45.8, R"(<?U?U9393?8D>JDPGSLZM_JfCh<g4d4k<nBnJmOjSfT_SYORIMFIAD)"},
    {0x33, 45.8, R"(KUSQVHUAQ<J9B8;93;3A:?A>G?KAOHLPCR=R=XCXKZN`KfCh<h5f5l=nCnKnPkTfUaRY)"},
    {0x34, 45.8, R"(Ig7KIK GmPmPKXKXEPEP9I9IE2E2L)"},
    {0x35, 45.8, R"(6mRmRh<h<[?[B\JZPWTQVJTBP=J9A8;94:4A:?A>G?KANJKSGUAV<U6S)"},
    {0x36, 45.8, R"(FV>S;J>AF>MAPJMS TlTfNhIhCg>d;^:U?ZF\MZSWVQWJVCR=M9F8@9<;8?5D4K3S4[6b9g=kCnInNn)"},
    {0x37, 45.8, R"(4mVmVjC9;9Mh4h)"},
    {0x38, 45.8, R"(ER=O:H=@E>M@PHMO >U7Y4a5f9k>nEnLnQkUfVaSYLUTPWHVAR<M9E8=98<4A3H6P ;`>ZEXLZO`LgEi>g)"},
    {0x39, 45.8, R"(6:6A;?A>G?KCNIPQKLDK=L7P4U3]4d7j=mDnJnNkRgUbV[WSVKTEQ?L;G9A8<9 DPLTN]LfDi<f:]<T)"},
    {0x3a, 24.3, R"(6B>B>969 6^>^>U6U)"},
    {0x3b, 24.3, R"(6^>^>U6U 6B>B><81416<)"},
    {0x3c, 60.3, R"(c\>PcCc<6M6Rcc)"},
    {0x3d, 60.3, R"(6ZcZcT6T 6KcKcE6E)"},
    {0x3e, 60.3, R"(6\6ccRcM6<6CZP)"},
    {0x3f, 38.2, R"(<BCBC9<9 CG<G<M=RAXD[G^HbFg@i:g3d3j:mAnGnKkNgObN]IXFTDRCPCNCK)"},
    {0x40, 72, R"(ILKDRAYD[LYTRWKT \AW=Q<K=G@DFCLDRGWK[Q\WZ\V\[a[aAiFkJlPkWg]ca_dYfSgKeCb?^;Y8S8L8G:B<=@9H3M2R2[3c7g4b1].X-R,L-F/A2<58:5@3F3L3R5X8^<bAfFiMkSlZkaigel`pXqPpHkBg?b=\<)"},
    {0x41, 49.3, R"(Gf=LPL CmKm_9W9RF;F69/9)"},
    {0x42, 49.4, R"(<R<?H?PASHPPHR <h<XGXNZQ`NfGh 5mGmNmTjWfXaVYOUWQZHYAV=P:H959)"},
    {0x43, 50.3, R"(\i\bUgLiDg>c<_:Z:S:M<H>CD?L>U?\D\=T9L8D9>;9?5E3K2S3[5b9g>kDnLnUm)"},
    {0x44, 55.4, R"(<h<?E?K?QAUDWHYMZSYZW_UcQeKgEh 5mDmMmTkZg^b`\aS`K^DZ?T<M:D959)"},
    {0x45, 45.5, R"(5mVmVh<h<XUXUR<R<?W?W959)"},
    {0x46, 41.4, R"(5mSmSh<h<XQXQR<R<959)"},
    {0x47, 55.8, R"(Y@YOMOMT`T`>W9R8L8E9>;9?5E3K2S3[5b9g>kEnLnVm_i_bVgMiDg>c<_:Z:S:M<G>CD?M>T>)"},
    {0x48, 54.1, R"(5m<m<XVXVm]m]9V9VR<R<959)"},
    {0x49, 21.2, R"(5m<m<959)"},
    {0x4a, 21.2, R"(5m<m<=;49/4,-+*+*1,1335=)"},
    {0x4b, 47.2, R"(5m<m<WTm]mCU_9U9<R<959)"},
    {0x4c, 40.1, R"(5m<m<?V?V959)"},
    {0x4d, 62.1, R"(5m@mMJ[meme9^9^gQCIC<g<959)"},
    {0x4e, 53.9, R"(5m?mVBVm]m]9S9<e<959)"},
    {0x4f, 56.7, R"(JiCg>c;\:S;J>DC?J>Q?WDZJ[SZ\WcQg JnQnWk\g`bb[cSbK`E\?W;Q9J8C9>;9?5E3K2S3[5b9g>kCn)"},
    {0x50, 43.4, R"(<h<TETMVO^MeEh 5mEmMlRiVeW^VWRRMOEN<N<959)"},
    {0x51, 56.7, R"(JiCg>c;\:S;J>DC?J>Q?WDZJ[SZ\WcQg T:^0U0M8L8J8C9>;9?5E3K2S3[5b9g>kCnJnQnWk\g`bb[cSbK_DZ>)"},
    {0x52, 50, R"(NRRNWG^9V9PFKMDO<O<9595mEmMmSjVeW^UV <h<UEUMWO^MeEh)"},
    {0x53, 45.7, R"(UlUeMhFi=f:`<[DXHWOUTRWMXGVAS<L9D8<93;3C;?D>M@PGNMFPBQ;S6V4Z3_4f8j=mEnMn)"},
    {0x54, 44, R"(.mZmZhHhH9@9@h.h)"},
    {0x55, 52.7, R"(4m;m;N<F>AB?H>N?RAUFUNUm\m\M\FZAW=Q9H8@99=7A5F4M)"},
    {0x56, 49.3, R"(C9/m6mGAWm_mK9)"},
    {0x57, 71.2, R"(0m8mCANmVmaAlmsmf9]9RgF9>9)"},
    {0x58, 49.3, R"(3m:mGZTm\mKT]9U9GO8909CU)"},
    {0x59, 44, R"(.m5mDXRmZmHRH9@9@R)"},
    {0x5a, 49.3, R"(2m[m[h:?\?\9191>Rh2h)"},
    {0x5b, 28.1, R"(4pCpCk;k;5C5C040)"},
    {0x5c, 24.3, R"(4mF2@2.m)"},
    {0x5d, 28.1, R"(DpD05055=5=k5k5p)"},
    {0x5e, 60.3, R"(PmcZ\ZLh=Z6ZIm)"},
    {0x5f, 36, R"(S-S(-(--)"},
    {0x60, 36, R"(;sEe?e4s)"},
    {0x61, 44.1, R"(GM@L<K9E;?A=JALFMKMM TOT9M9M?H:@8:96;3?2D3J7N<QDRMRJYB\;[5Y5_<aCaJ`O]SW)"},
    {0x62, 45.7, R"(QMPSNXF\>X<S;M<F>AF=NAPF ;Z@`HaN`S\WUXMWDS>N9H8@:;?;9595p;p)"},
    {0x63, 39.6, R"(Q_QYL[F\@[<X:S9M:F<A@>F=L>Q@Q;L9E8=97>3D2M3U7\>`FaLa)"},
    {0x64, 45.7, R"(OZOpUpU9O9O?J:B8<96>3D2M3U6\<`BaJ` 9M9F<AD=LANFOMNSLXD\<X9S)"},
    {0x65, 44.3, R"(VNVK9K:E=AA>G=N>UAU;N9F8>97=3D2L3U7\=`EaL`R\UV PPMYE\=Y9P)"},
    {0x66, 25.3, R"(IpIjCj>i<d<`G`G[<[<9696[0[0`6`6c7i9m=oCp)"},
    {0x67, 45.7, R"(OMNSLXD\<X9S9M9G<BD>LBNG U>T5Q/K+C*=+7,72<0B/H0L3N7O=O@J;B9<:6?3E2M3U6\<`BaJ`OZO`U`)"},
    {0x68, 45.6, R"(VQV9O9OQMYF\>X;O;9595p;p;ZA`HaN`R]UX)"},
    {0x69, 20, R"(5`;`;959 5p;p;h5h)"},
    {0x6a, 20, R"(5`;`;8;28-5+/*-*-0.03158 5p;p;h5h)"},
    {0x6b, 41.7, R"(5p;p;ON`W`BNW9O9;L;959)"},
    {0x6c, 20, R"(5p;p;959)"},
    {0x6d, 70.1, R"(SYY_aag`k]mXnQn9h9hQfY_\WXUOU9N9NQLYF\>X;O;9595`;`;Z@`HaO_)"},
    {0x6e, 45.6, R"(VQV9O9OQMYF\>X;O;9595`;`;ZA`HaN`R]UX)"},
    {0x6f, 44.1, R"(D\<X:S9M:F<BD=LBOFOMOSLX DaL`Q\UUVMUDQ=L9D8<97=3D2M3U7\<`)"},
    {0x70, 45.7, R"(;?;*5*5`;`;Z@`HaN`S\WUXMWDS>N9H8@: QMPSNXF\>X<S;M<F>AF=NAPF)"},
    {0x71, 45.7, R"(9M9F<AD=LANFOMNSLXD\<X9S O?J:B8<96>3D2M3U6\<`BaJ`OZO`U`U*O*)"},
    {0x72, 29.6, R"(LZI[F\>X<T;N;9595`;`;Z@`HaJaLa)"},
    {0x73, 37.5, R"(N_NYH[B\;Z8V:RAPCPINMKPDO?L;F9@8992:2A9>@=G?ICHG@J>K5O2V3[6^;aAaHa)"},
    {0x74, 28.2, R"(;l;`I`I[;[;F=@B>I>I9B9<:8<5@5F5[0[0`5`5l)"},
    {0x75, 45.6, R"(4I4`;`;I=@C>LAOJO`U`U9O9O?I:B8<98<5A Da)"},
    {0x76, 42.6, R"(0`7`C?P`V`H9?9)"},
    {0x77, 58.9, R"(1`7`@BH`O`WB_`f`\9T9KYC9;9)"},
    {0x78, 42.6, R"(V`GMV9O9CH8909?N1`9`CRN`)"},
    {0x79, 42.6, R"(E5B0@,9*4*4/7/<1?7@:0`7`CBP`V`)"},
    {0x7a, 37.8, R"(2`Q`QZ8>Q>Q9191?I[2[)"},
    {0x7b, 45.8, R"(S2S-Q-I.E0C4B:BC@J9L7L7Q9Q@SBZBcCiEmIoQpSpSkPkJiHcHZGRAOGKHCH:J4P2)"},
    {0x7c, 24.3, R"(=p=(7(7p)"},
    {0x7d, 45.8, R"(7292@4A:ACCKHOCRAZAc@i9k7k7p9pAoEmGiHcHZJSQQSQSLQLJJHCH:G4E0A.9-7-)"},
    {0x7e, 60.3, R"(cVcO\KUJLLLMKMBO<N6I6P<TCULSMSMRVP\Q)"},
    {0xb0, 36, R"(@j;h9c;^@]E^GcEh @nDnHkJhKcH[@X8[5c8k)"},
    {0xb2, 28.9, R"(7TFTFP1P1T5W;^?bAe?i:k6j2h2l7n;nClFfEbA]:W)"},
    {0xb3, 28.9, R"(@`E^GYDR:P6P1Q1V5T:T@UBY@]:^7^7b:b?cAf?j:k7j2i2m7n;nClFgEc)"},
    {0xb7, 22.9, R"(6V=V=N6N)"},
    {0xc5, 49.3, R"(LrJvGxCvArCnGmJn Gf=LPL Aj>n=r@yG|MyPrOnLj_9W9RF;F69/9)"},
    {0xd7, 60.3, R"(``PP`?\;LK<;8?HP8`<dLT\d)"},
    {0x2013, 36, R"(2ONONJ2J)"},
    {0x2026, 72, R"(NBVBV9N9 fBnBn9f9 6B>B>969)"},};
// clang-format on

} // namespace

const Glyph& glyph_of(uint32_t code) {
  const Glyph* unknown = glyphs;
  for (const Glyph& g : glyphs) {
    if (g.code == code)
      return g;
    if (g.code == '?')
      unknown = &g;
  }
  return *unknown;
}

} // namespace molmesh::picture
