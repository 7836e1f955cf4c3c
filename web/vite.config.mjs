import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { defineConfig } from "vite";

/** The licences of the packages whose code is in the page: they ask to be kept with it. */
function licences(modules) {
  const folders = new Set(modules.map((id) => /\/.*\/node_modules\/(?:@[^/]+\/)?[^/]+/.exec(id)?.[0]).filter(Boolean));
  const texts = [...folders].sort().map((folder) => {
    const { name, version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? readFileSync(join(folder, file), "utf8").replaceAll("\r", "").trim() : "";
    return `${name} ${version} (${license})\n\n${text}`;
  });
  const rule = `\n\n${"-".repeat(20)}\n\n`.replaceAll("--", "- ");
  return `Riven's report page, Apache-2.0. It holds code of:\n\n${texts.join(rule)}\n`.replaceAll("-->", "- ->");
}

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
      const modules = Object.values(bundle).flatMap((item) => Object.keys(item.modules ?? {}));
      // Functions as replacements: in a text, "$&" and the like would be expanded.
      page.source = page.source
        .replace(styleTag, (_tag, file) => `<style>${take(file)}</style>`)
        .replace(scriptTag, (_tag, file) => {
          const code = take(file).replaceAll("</script", "<\\/script");
          return `<script type="module">${code}</script>`;
        })
        .replace("</html>", () => `<!--\n${licences(modules)}-->\n</html>`);
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
