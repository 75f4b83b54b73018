/* page_checks.js - what tests of pages check alike: contrast of text, names of pictures and controls, links, size on disk. */
'use strict';
const fs = require('fs');
const path = require('path');

const sizeOf = (p) => fs.statSync(p).isDirectory()
    ? fs.readdirSync(p).reduce((s, f) => s + sizeOf(path.join(p, f)), 0) : fs.statSync(p).size;

// The least contrast of the text on the page: of each element that has text of its own, against its background.
const CONTRAST = `(() => {
    const rgb = (c) => (c.match(/[\\d.]+/g) || []).map(Number);
    const light = (c) => c.slice(0, 3).map((v) => v / 255)
        .map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
        .reduce((s, v, i) => s + v * [0.2126, 0.7152, 0.0722][i], 0);
    const ground = (e) => {
        for (; e; e = e.parentElement) {
            const c = rgb(getComputedStyle(e).backgroundColor);
            if (c.length === 3 || c[3] > 0.5) return c;
        }
        return [255, 255, 255];
    };
    let least = [99, ''];
    for (const e of document.querySelectorAll('body *')) {
        if (e.closest('svg, .ba, select, video') || !e.offsetParent || e.matches(':disabled, :disabled *')) continue;
        if (![...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim())) continue;
        const a = light(rgb(getComputedStyle(e).color)), b = light(ground(e));
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        if (ratio < least[0]) least = [ratio, e.outerHTML.slice(0, 120)];
    }
    return least;
})()`;

const NAMELESS = `(() => {
    const bad = [];
    for (const e of document.querySelectorAll('img'))
        if (!e.alt && !e.hidden) bad.push(e.outerHTML.slice(0, 120));
    for (const e of document.querySelectorAll('input, select, video'))
        if (e.offsetParent && !e.getAttribute('aria-label') &&
            !(e.labels && e.labels.length && e.labels[0].textContent.trim()))
            bad.push(e.outerHTML.slice(0, 120));
    return bad;
})()`;

const deadLinks = async (page, html) => {
    const links = await page.run(`[...document.querySelectorAll('[href], [src], [poster], [data-made], [data-ratio]')]
        .flatMap((e) => ['href', 'src', 'poster', 'data-made', 'data-ratio'].map((a) => e.getAttribute(a)))
        .filter((a) => a && !a.startsWith('data:'))`);
    const here = path.dirname(html), dead = [];
    for (const link of new Set(links)) {
        if (link.startsWith('#')) {
            if (!await page.run(`!!document.getElementById(${JSON.stringify(link.slice(1))})`)) dead.push(link);
        } else if (!fs.existsSync(path.join(here, decodeURIComponent(link)))) {
            dead.push(link);
        }
    }
    return dead;
};

const phoneWidth = async (browser, url) =>
    (await browser.page(url, 390, 800)).run('document.documentElement.scrollWidth');

const checkSize = (check, size) => {
    console.log(`# the page and its pictures: ${(size / 1e6).toFixed(2)} MB`);
    check('the_page_takes_at_most_10_MB', size <= 10e6, `${size} bytes`);
};

module.exports = {sizeOf, CONTRAST, NAMELESS, deadLinks, phoneWidth, checkSize};
