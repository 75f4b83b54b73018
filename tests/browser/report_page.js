// node report_page.js FOLDER - opens the pages of a scene with changes (FOLDER/index.html, page/numbers.html,
// remodel/index.html) in Chromium.
//
// The line between before and after moves by keys and by pointer; a choice of change or light changes the picture;
// without scripts both halves and all pictures can be reached. Names, contrast, width on a phone, links, size on disk,
// and an empty console.
'use strict';
const fs = require('fs');
const os = require('os');
const path = require('path');
const {Chromium} = require('./chromium.js');
const {sizeOf, CONTRAST, NAMELESS, deadLinks, phoneWidth, checkSize} = require('./page_checks.js');
const folder = path.resolve(process.argv[2]);
let failed = 0;
const check = (name, fine, why) => {
    console.log(`${fine ? 'ok' : 'not ok'} ${name}${fine ? '' : `: ${why}`}`);
    failed += !fine;
};

// The first figure's picture, as it is now.
const LOOK = `(() => {
    const f = document.querySelector('figure.room'), ba = f.querySelector('.ba'), after = f.querySelector('.after');
    return {at: parseFloat(ba.style.getPropertyValue('--p')), src: after.getAttribute('src'), alt: after.alt,
        label: f.querySelector('.right').textContent, says: f.querySelector('.says').textContent,
        clip: getComputedStyle(f.querySelector('.before')).clipPath,
        value: f.querySelector('input[type=range]').getAttribute('aria-valuetext')};
})()`;

const tryTheSlider = async (page) => {
    await page.run('document.querySelector(".ba input").focus()');
    const start = await page.run(LOOK);
    for (let i = 0; i < 7; i++) await page.key('ArrowRight');
    const right = await page.run(LOOK);
    check('arrow_keys_move_the_line', start.at === 50 && right.at === 57, `${start.at} became ${right.at}`);
    check('the_line_says_where_it_is', /57 %/.test(right.value), right.value);
    const [x, y, w, h] = await page.run(`(() => {
        const r = document.querySelector('.ba').getBoundingClientRect();
        return [r.x, r.y, r.width, r.height];
    })()`);
    await page.drag([x + 0.5 * w, y + h / 2], [x + 0.2 * w, y + h / 2]);
    const left = await page.run(LOOK);
    check('the_pointer_moves_the_line', Math.abs(left.at - 20) <= 1, left.at);
    check('the_picture_before_ends_at_the_line', left.clip.includes(`${100 - left.at}%`), left.clip);
};

const tryTheChoices = async (page) => {
    const first = await page.run(LOOK);
    const options = await page.run('[...document.querySelector("figure.room select").options].map((o) => o.value)');
    const loaded = `(async () => {
        const i = document.querySelector('.after');
        await i.decode();
        return i.naturalWidth;
    })()`;
    check('the_scene_has_two_changes_in_a_picture', options.length > 1, options.join(' '));
    await page.run('document.querySelector("figure.room select").focus()');
    await page.key('ArrowDown');
    const second = await page.run(LOOK);
    check('a_chosen_change_changes_the_picture', second.src !== first.src && second.alt !== first.alt, second.alt);
    check('its_picture_is_there', await page.run(loaded) > 0, 'it does not load');
    check('its_name_and_what_is_real_are_said', second.label !== first.label && second.says.length > 20, second.label);
    const lit = await page.run(`(() => {
        for (const f of document.querySelectorAll('figure.room'))
            for (const o of f.querySelector('select').options) {
                f.querySelector('select').value = o.value;
                f.querySelector('select').dispatchEvent(new Event('change'));
                const day = f.querySelector('input[value=day]'), fresh = f.querySelector('input[value=new]');
                if (!fresh || fresh.disabled) continue;
                const src = () => f.querySelector('.after').getAttribute('src');
                fresh.click();
                const a = src(), over = f.querySelector('.over');
                f.querySelector('input[type=checkbox]').click();
                const shown = !over.hidden && over.getAttribute('src');
                day.click();
                return {a, b: src(), over: shown};
            }
        return null;
    })()`);
    check('new_light_can_be_chosen', lit && lit.a && lit.b && lit.a !== lit.b, JSON.stringify(lit));
    check('what_is_real_can_be_shown', lit && !!lit.over, JSON.stringify(lit));
    const all = await page.run(`(() => {
        const s = document.getElementById('change-all');
        s.value = ${JSON.stringify(options[1])};
        s.dispatchEvent(new Event('change'));
        const shown = [...document.querySelectorAll('figure.room')].filter((f) => !f.hidden);
        return {changes: shown.map((f) => f.querySelector('select').value),
            said: document.querySelector('[role=status]').textContent};
    })()`);
    check('one_choice_serves_all_pictures', all.changes.length > 0 && all.changes.every((c) => c === options[1]) &&
        all.said.includes('photographs show it'), JSON.stringify(all));
};

const tryWithoutScripts = async (browser, url) => {
    const page = await browser.page('about:blank');
    await page.send('Emulation.setScriptExecutionDisabled', {value: true});
    await page.send('Page.navigate', {url});
    await new Promise((done) => setTimeout(done, 500));
    const found = await page.run(`(() => {
        const shown = (s) => [...document.querySelectorAll(s)].some((e) => e.offsetParent);
        return {lists: shown('.looks a'), line: shown('.ba input'), both: shown('.before') && shown('.after')};
    })()`);
    check('without_scripts_all_pictures_are_linked', found.lists && found.both && !found.line, JSON.stringify(found));
};

const main = async () => {
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'report-browser-'));
    const browser = await Chromium.open(profile);
    const urlOf = (file) => `file://${path.join(folder, file)}`;
    try {
        const pages = {scene: 'index.html', numbers: 'page/numbers.html', changes: 'remodel/index.html'};
        for (const [name, file] of Object.entries(pages)) {
            const page = await browser.page(urlOf(file), 1280, 900), html = path.join(folder, file);
            const dead = await deadLinks(page, html), nameless = await page.run(NAMELESS);
            check(`all_links_of_the_page_of_${name}_lead_somewhere`, !dead.length, dead.join(' '));
            check(`all_pictures_and_controls_of_the_page_of_${name}_have_names`, !nameless.length, nameless.join(' '));
            for (const scheme of ['light', 'dark']) {
                await page.send('Emulation.setEmulatedMedia',
                    {features: [{name: 'prefers-color-scheme', value: scheme}]});
                const [ratio, where] = await page.run(CONTRAST);
                check(`${scheme}_text_of_the_page_of_${name}_has_contrast`, ratio >= 4.5, `${ratio} in ${where}`);
            }
            if (name !== 'numbers') await tryTheSlider(page);
            if (name === 'scene') await tryTheChoices(page);
            check(`the_console_of_the_page_of_${name}_is_empty`, !page.errors.length, page.errors.join(' | '));
            const width = await phoneWidth(browser, urlOf(file));
            check(`the_page_of_${name}_fits_a_phone`, width <= 390, `it is ${width} px wide`);
        }
        await tryWithoutScripts(browser, urlOf('index.html'));
        const size = sizeOf(path.join(folder, 'index.html')) + sizeOf(path.join(folder, 'page'));
        checkSize(check, size);
    } finally {
        await browser.close(profile);
    }
    process.exit(failed ? 1 : 0);
};
main().catch((e) => {
    console.log(`not ok the_page: ${e.stack}`);
    process.exit(1);
});
