/* store.js - nothing that was typed is lost: changes are kept in the browser until they are saved, to the scene's folder
 * where the browser can, else as downloads. */
'use strict';

class Store {
    constructor(scene, texts) {
        this.key = 'remodel draw ' + scene;
        this.texts = texts;
        this.scene = scene;
        this.onDisk = {...texts.now}; /* as the page was made, or saved since */
        this.folder = null;
        window.addEventListener('beforeunload', (e) => { if (this.unsaved().length) e.preventDefault(); });
        texts.watch(() => this.keep());
    }

    unsaved() {
        const names = new Set([...Object.keys(this.onDisk), ...Object.keys(this.texts.now)]);
        return [...names].filter((name) => this.onDisk[name] !== this.texts.now[name]);
    }

    keep() {
        const kept = {};
        for (const name of this.unsaved()) kept[name] = {from: this.onDisk[name] ?? null,
            to: this.texts.now[name] ?? null};
        try {
            if (Object.keys(kept).length) localStorage.setItem(this.key, JSON.stringify(kept));
            else localStorage.removeItem(this.key);
        } catch (e) { /* without storage the guard before closing remains */ }
    }

    /* Takes back what was not saved. Returns the names of these files. */
    restore() {
        let kept = {};
        try { kept = JSON.parse(localStorage.getItem(this.key) || '{}'); } catch (e) { return []; }
        const names = Object.keys(kept).filter((name) => (kept[name].to ?? undefined) !== this.onDisk[name]);
        for (const name of names) this.texts.put(name, kept[name].to ?? undefined);
        this.changedSince = names.filter((name) => kept[name].from !== (this.onDisk[name] ?? null));
        return names;
    }

    /* Returns what was done, as a sentence. */
    async save() {
        const names = this.unsaved().filter((name) => this.texts.now[name] !== undefined);
        if (!names.length) return 'Nothing to save.';
        if (window.showDirectoryPicker) {
            this.folder = this.folder || await window.showDirectoryPicker({id: 'remodel', mode: 'readwrite'});
            for (const name of names) await this.writeTo(this.folder, name.split('/'), this.texts.now[name]);
        } else
            for (const name of names) this.download(name.split('/').pop(), this.texts.now[name]);
        for (const name of names) this.onDisk[name] = this.texts.now[name];
        this.keep();
        return window.showDirectoryPicker ? `Saved ${names.join(', ')}.`
            : `Downloaded ${names.join(', ')}: put ${names.length > 1 ? 'them' : 'it'} into scenes/${this.scene}/${names.some((n) => n.includes('/')) ? ' (edits into its folder edits)' : ''}.`;
    }

    async writeTo(folder, parts, text) {
        if (parts.length > 1) return this.writeTo(await folder.getDirectoryHandle(parts[0], {create: true}),
            parts.slice(1), text);
        const file = await (await folder.getFileHandle(parts[0], {create: true})).createWritable();
        await file.write(text);
        await file.close();
    }

    download(name, text) {
        const link = document.createElement('a');
        link.href = URL.createObjectURL(new Blob([text], {type: 'text/plain'}));
        link.download = name;
        link.click();
    }
}
