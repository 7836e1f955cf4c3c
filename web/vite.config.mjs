import { defineConfig } from "vite";

/**
 * Puts the script and the style sheet into the page itself: a report must open from a folder, by file://, where a
 * browser loads no modules from beside the page.
 */
function oneFile() {
  const scriptTag = /<script type="module"[^>]*src="\.?\/?([^"]+)"[^>]*><\/script>/;
  const styleTag = /<link rel="stylesheet"[^>]*href="\.?\/?([^"]+)"[^>]*>/;
  return {
    name: "one-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["report.html"];
      const take = (file) => {
        const item = bundle[file];
        delete bundle[file];
        return item.code ?? item.source;
      };
      // Functions as replacements: in a text, "$&" and the like would be expanded.
      page.source = page.source
        .replace(styleTag, (_tag, file) => `<style>${take(file)}</style>`)
        .replace(scriptTag, (_tag, file) => {
          const code = take(file).replaceAll("</script", "<\\/script");
          return `<script type="module">${code}</script>`;
        });
      const left = Object.keys(bundle).filter((file) => file !== "report.html");
      if (left.length > 0) this.error(`not in the page: ${left.join(", ")}`);
    },
  };
}

export default defineConfig({
  base: "./",
  logLevel: "warn",
  plugins: [oneFile()],
  build: {
    target: "es2022",
    cssCodeSplit: false,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 2000,
    rollupOptions: { input: "report.html", output: { inlineDynamicImports: true } },
  },
});
